// Pose files as they stand.
#include <gtest/gtest.h>

#include "motion/pose_table.h"
#include "outcome_matchers.h"
#include "support/temp_folder.h"

namespace accrete::hal {
namespace {

using test::TempFolder;

class Poses : public testing::Test {
 protected:
  Outcome read(const std::string& text) { return read_poses(folder_.write("poses.txt", text), table_); }
  TempFolder folder_;
  PoseTable table_;
};

TEST_F(Poses, TumHasSecondsAndWLast) {
  ASSERT_TRUE(
      succeeds(read("\xef\xbb\xbf# t tx ty tz qx qy qz qw\r\n1403636579.763555584 1 2 3 0 0 0.6 0.8  \r\n\r\n"
                    "1403636580.0 4 5 6 0 0 0 -1")));
  EXPECT_EQ(table_.format, PoseFormat::kTum);
  ASSERT_EQ(table_.poses.size(), 2U);
  EXPECT_EQ(table_.poses[0].t.ns, 1403636579763555584);
  EXPECT_EQ(table_.poses[0].translation, (Vec3{1, 2, 3}));
  EXPECT_EQ(table_.poses[0].rotation, (Quaternion{0, 0, 0.6, 0.8}));
  EXPECT_EQ(table_.poses[1].line, 4U);
  EXPECT_TRUE(table_.notices.empty());
}

TEST_F(Poses, TumInNanosecondsIsScaledWithANotice) {
  ASSERT_TRUE(succeeds(read("1403636579763555584 1 2 3 0 0 0 1\n1403636579813555456 1 2 3 0 0 0 1\n")));
  EXPECT_EQ(table_.poses[1].t.ns, 1403636579813555456);
  EXPECT_TRUE(says(table_.notices, {"poses.txt", "nanoseconds"}));
}

TEST_F(Poses, KittiIsAMatrixALineAndNeedsNoLastNewline) {
  ASSERT_TRUE(succeeds(read("1 0 0 0 0 1 0 0 0 0 1 0\n0 -1 0 4 1 0 0 5 0 0 1 6")));
  EXPECT_EQ(table_.format, PoseFormat::kKitti);
  ASSERT_EQ(table_.poses.size(), 2U);
  EXPECT_EQ(table_.poses[1].translation, (Vec3{4, 5, 6}));
  EXPECT_LT(norm(to_matrix(table_.poses[1].rotation) * Vec3{1, 0, 0} - Vec3{0, 1, 0}), 1e-15);
}

TEST_F(Poses, EurocHasNanosecondsAndWFirst) {
  for (const char* head : {"#timestamp, p_RS_R_x [m], ...\n", "timestamp,x,y,z,w,x,y,z\n", ""}) {
    ASSERT_TRUE(
        succeeds(read(std::string(head) + "1403636580838555648,4.6,-1.7,0.8,0.8,0,0,0.6,1,2,3,4,5,6,7,8,9\r\n")))
        << head;
    EXPECT_EQ(table_.format, PoseFormat::kEuroc);
    EXPECT_EQ(table_.poses[0].t.ns, 1403636580838555648);
    EXPECT_EQ(table_.poses[0].rotation, (Quaternion{0, 0, 0.6, 0.8}));
    EXPECT_EQ(table_.poses[0].translation[1], -1.7);
  }
  ASSERT_TRUE(succeeds(read("1520621263000000000, 1, 2, 3, 1, 0, 0, 0,\n")));  // eight columns and a comma too many
  EXPECT_EQ(table_.poses[0].rotation.w, 1);
  EXPECT_TRUE(
      fails(read("15.5,1,2,3,1,0,0,0\n"), Status::kInvalidArgument, {"poses.txt, line 1", "'15.5'", "nanoseconds"}));
}

TEST_F(Poses, OutOfOrderIsSortedAndRepeatedDroppedWithNotices) {
  ASSERT_TRUE(succeeds(read("2 1 0 0 0 0 0 1\n1 2 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n")));
  ASSERT_EQ(table_.poses.size(), 2U);
  EXPECT_EQ(table_.poses[0].translation[0], 2);
  EXPECT_TRUE(says(table_.notices, {"poses.txt", "sorted"}));
  EXPECT_TRUE(says(table_.notices, {"poses.txt", "1 repeated line"}));
}

TEST_F(Poses, OneTimeWithTwoPosesIsRefused) {
  EXPECT_TRUE(fails(read("1 1 0 0 0 0 0 1\n1 2 0 0 0 0 0 1\n"), Status::kInvalidArgument,
                    {"poses.txt, line 2", "line 1", "remove one"}));
}

TEST_F(Poses, RefusesWithTheLine) {
  const std::string good = "0 1 2 3 0 0 0 1\n";
  EXPECT_TRUE(
      fails(read(good + "1 nan 2 3 0 0 0 1\n"), Status::kInvalidArgument, {"poses.txt, line 2", "column 2", "'nan'"}));
  EXPECT_TRUE(fails(read(good + "1 inf 2 3 0 0 0 1\n"), Status::kInvalidArgument, {"line 2", "'inf'"}));
  EXPECT_TRUE(fails(read(good + "nan 1 2 3 0 0 0 1\n"), Status::kInvalidArgument, {"line 2", "'nan'", "seconds"}));
  EXPECT_TRUE(fails(read(good + "1 1 2 3 0 0 0 0\n"), Status::kInvalidArgument, {"line 2", "length 0", "no rotation"}));
  EXPECT_TRUE(fails(read(good + "1 1 2 3 0 0 nan 1\n"), Status::kInvalidArgument, {"line 2", "column 7"}));
  EXPECT_TRUE(fails(read(good + "1 1 2 3 0 0\n"), Status::kDataLoss, {"line 2", "columns", "truncated"}));
  EXPECT_TRUE(fails(read(good + "1 1 2 3 0 0 0 one\n"), Status::kInvalidArgument, {"line 2", "'one'"}));
  EXPECT_TRUE(fails(read("1 0 0 0 0 1 0 0 0 0 2 0\n"), Status::kInvalidArgument, {"line 1", "3 x 3", "no rotation"}));
  EXPECT_TRUE(fails(read("1 0 0 0 0 1 0 0 0 0 -1 0\n"), Status::kInvalidArgument, {"line 1", "mirrors"}));
  EXPECT_TRUE(fails(read("1 2 3\n"), Status::kUnsupported, {"line 1", "TUM", "KITTI", "EuRoC"}));
  EXPECT_TRUE(fails(read("# nothing\n"), Status::kDataLoss, {"poses.txt", "no poses"}));
  EXPECT_TRUE(fails(read(std::string(100'000, '1')), Status::kUnsupported, {"line 1"}));
}

}  // namespace
}  // namespace accrete::hal
