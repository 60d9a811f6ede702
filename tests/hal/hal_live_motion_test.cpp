// Live poses: the lines, hostile ones too, what is held of them, and the streams that they come from.
#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <random>
#include <thread>

#include "motion/line_splitter.h"
#include "motion/live_poses.h"
#include "outcome_matchers.h"
#include "support/temp_folder.h"

namespace accrete::hal {
namespace {

constexpr std::int64_t kMs = 1'000'000;

std::string pose_at(double seconds, double x = 0) {
  return std::to_string(seconds) + " " + std::to_string(x) + " 0 1 0 0 0 1";
}

LivePoses poses(const LiveMotionOptions& options = {}) { return {options, "poses"}; }

TEST(LivePoses, InterpolatesBetweenLines) {
  LivePoses p = poses();
  p.line("# t tx ty tz qx qy qz qw");
  p.line("");
  p.line("10.00 0 0 1 0 0 0 1\r");
  EXPECT_TRUE(p.may_come({10'005 * kMs}));
  p.line(" 10.02\t0.2 0 1 0 0 0 1  ");
  EXPECT_FALSE(p.may_come({10'005 * kMs}));
  Motion m;
  ASSERT_TRUE(succeeds(p.at({10'005 * kMs}, m)));
  EXPECT_NEAR(m.T_l_m.translation[0], 0.05, 1e-12);
  EXPECT_EQ(m.t.ns, 10'005 * kMs);
  EXPECT_TRUE(m.covariance_is_default);
  EXPECT_EQ(p.counters().poses, 2U);
  EXPECT_EQ(p.counters().served, 1U);
  EXPECT_EQ(p.counters().malformed, 0U);
}

TEST(LivePoses, NanosecondsAreTold) {
  LivePoses p = poses();
  p.line("1700000000123456789 0 0 1 0 0 0 1");
  Motion m;
  EXPECT_TRUE(succeeds(p.at({1700000000123456789}, m)));
}

TEST(LivePoses, TakesACovariance) {
  LivePoses p = poses();
  std::string line = pose_at(1), other = pose_at(1.02);
  int k = 0;
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j, ++k) {
      line += i == j ? " 4" : k == 1 ? " 1" : " 0";
      other += i == j ? " 2" : " 0";
    }
  p.line(line);
  p.line(other);
  p.line(pose_at(1.03));  // other columns than before
  EXPECT_EQ(p.counters().malformed, 1U);
  Motion m;
  ASSERT_TRUE(succeeds(p.at({1'010 * kMs}, m)));
  EXPECT_FALSE(m.covariance_is_default);
  EXPECT_DOUBLE_EQ(m.covariance[0], 3);
  EXPECT_DOUBLE_EQ(m.covariance[1], 0.5);
  EXPECT_DOUBLE_EQ(m.covariance[6], 0.5);
  EXPECT_EQ(validate(m), Status::kOk);
  line[line.size() - 1] = '0';  // the last variance: singular
  p.line(line);
  EXPECT_EQ(p.counters().malformed, 2U);
}

TEST(LivePoses, ConventionsAreThoseOfFiles) {
  LiveMotionOptions options;
  options.mode = MotionMode::kCameraMoves;
  options.T_l_f.translation = {0.1, 0, 0};  // the lines are about the right camera
  options.sigma_m = options.sigma_rad = 0.01;
  LivePoses p = poses(options);
  p.line("1 0.1 0 0 0 0 0 1");  // T_world_right
  Motion m;
  ASSERT_TRUE(succeeds(p.at({1'000 * kMs}, m)));
  EXPECT_EQ(m.mode, MotionMode::kCameraMoves);
  EXPECT_EQ(m.error, PoseError::kIncremental);
  EXPECT_NEAR(norm(m.T_l_m.translation), 0, 1e-12);
  EXPECT_DOUBLE_EQ(m.covariance[0], 1e-4);
  options = {};
  options.inverse = true;
  LivePoses q = poses(options);
  q.line("1 0 0 2 0 0 0 1");
  ASSERT_TRUE(succeeds(q.at({1'000 * kMs}, m)));
  EXPECT_NEAR(m.T_l_m.translation[2], -2, 1e-12);
}

TEST(LivePoses, CountsWhatIsNoPose) {
  LivePoses p = poses();
  std::uint64_t n = 0;
  for (const std::string& bad :
       {std::string("hello"), std::string("1 2 3"), std::string("1 0 0 1 0 0 0 1 5"), std::string("nan 0 0 1 0 0 0 1"),
        std::string("1 nan 0 1 0 0 0 1"), std::string("1 0 inf 1 0 0 0 1"), std::string("1 0 0 1 0 0 0 0"),
        std::string("1 0 0 1 9 9 9 9"), std::string("1,0,0,1,0,0,0,1"), std::string("1e300 0 0 1 0 0 0 1"),
        std::string("9223372036854775807 0 0 1 0 0 0 1"), std::string(5000, '1'), std::string("\0\xff\x7f", 3)}) {
    p.line(bad);
    EXPECT_EQ(p.counters().malformed, ++n) << bad;
  }
  EXPECT_EQ(p.counters().poses, 0U);
  Motion m;
  EXPECT_TRUE(fails(p.at({0}, m), Status::kNotFound, {"poses", "is empty"}));
}

TEST(LivePoses, CountsEarlyMissingAndLate) {
  LivePoses p = poses();
  Motion m;
  p.line(pose_at(10));
  EXPECT_EQ(p.at({9'000 * kMs}, m).status, Status::kNotFound);
  EXPECT_EQ(p.counters().early, 1U);
  EXPECT_EQ(p.at({10'020 * kMs}, m).status, Status::kNotFound);  // given up
  EXPECT_EQ(p.counters().missing, 1U);
  p.line(pose_at(10.01));
  EXPECT_EQ(p.counters().late, 1U);
  p.line(pose_at(10.5));
  EXPECT_EQ(p.counters().late, 1U);
  EXPECT_TRUE(fails(p.at({10'200 * kMs}, m), Status::kNotFound, {"--max-pose-gap"}));
  EXPECT_EQ(p.counters().missing, 2U);
}

TEST(LivePoses, TimeThatRunsBackwards) {
  LivePoses p = poses();
  Motion m;
  p.line(pose_at(10, 1));
  p.line(pose_at(10.04, 5));
  p.line(pose_at(10.02, 3));  // overtaken on the way: used at its place
  p.line(pose_at(10.02, 9));  // the same time again: the first one stays
  EXPECT_EQ(p.counters().backwards, 2U);
  ASSERT_TRUE(succeeds(p.at({10'010 * kMs}, m)));
  EXPECT_NEAR(m.T_l_m.translation[0], 2, 1e-9);
  ASSERT_TRUE(succeeds(p.at({10'020 * kMs}, m)));
  EXPECT_NEAR(m.T_l_m.translation[0], 3, 1e-9);
  p.line(pose_at(1e9, 7));  // one stamp that is nonsense must not shut out what follows
  p.line(pose_at(10.06, 7));
  EXPECT_TRUE(p.may_come({10'070 * kMs}));
  ASSERT_TRUE(succeeds(p.at({10'050 * kMs}, m)));
  EXPECT_NEAR(m.T_l_m.translation[0], 6, 1e-9);
  p.line(pose_at(2));  // the clock was set back: what lies after it is void
  EXPECT_EQ(p.held(), 1U);
}

TEST(LivePoses, HoldsABoundedNumber) {
  LiveMotionOptions options;
  options.capacity = 100;
  LivePoses p = poses(options);
  for (int i = 0; i < 10'000; ++i) p.line(pose_at(0.01 * i));
  EXPECT_LT(p.held(), 200U);
  EXPECT_GE(p.held(), 100U);
  Motion m;
  EXPECT_TRUE(p.at({99'005 * kMs}, m).ok());
  EXPECT_FALSE(p.at({5 * kMs}, m).ok());
  EXPECT_EQ(p.counters().early, 1U);
}

TEST(LivePoses, RandomBytesAreCountedAndNothingElse) {
  std::mt19937 random(7);
  LivePoses p = poses();
  LineSplitter splitter;
  std::vector<char> bytes(1 << 20);
  for (char& c : bytes) c = static_cast<char>(random());
  std::size_t longest = 0;
  const auto use = [&](std::string_view line) {
    longest = std::max(longest, line.size());
    p.line(line);
  };
  splitter.feed(bytes, use);
  const std::vector<char> endless(1 << 20, 'x');
  splitter.feed(endless, use);
  splitter.end(use);
  EXPECT_LE(longest, Row::kMaxLength + 1);
  EXPECT_GT(p.counters().malformed, 1000U);
  EXPECT_EQ(p.counters().poses, 0U);
  const std::string good = pose_at(1) + "\n";
  splitter.feed(good, use);
  EXPECT_EQ(p.counters().poses, 1U);
}

// Until `met`, at most 5 s.
bool eventually(const std::function<bool()>& met) {
  for (int i = 0; i < 1000 && !met(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  return met();
}

TEST(LiveMotion, TellsStreamsFromFiles) {
  for (const char* live : {"-", "fifo:/tmp/x", "udp:5005", "udp:0.0.0.0:5005"}) EXPECT_TRUE(is_live_motion(live));
  for (const char* file : {"", "poses.txt", "./-", "tcp:1"}) EXPECT_FALSE(is_live_motion(file));
}

TEST(LiveMotion, SaysWhatCannotBeOpened) {
  const test::TempFolder folder;
  const std::string file = folder.write("file", "x").string();
  std::unique_ptr<LiveMotion> motion;
  EXPECT_TRUE(fails(open_live_motion("fifo:" + (folder / "no").string(), {}, motion), Status::kNotFound, {"mkfifo"}));
  EXPECT_TRUE(fails(open_live_motion("fifo:" + file, {}, motion), Status::kInvalidArgument, {"no FIFO"}));
  EXPECT_TRUE(fails(open_live_motion("udp:70000", {}, motion), Status::kInvalidArgument, {"65535"}));
  EXPECT_TRUE(fails(open_live_motion("udp::5", {}, motion), Status::kInvalidArgument, {"udp:HOST:PORT"}));
  EXPECT_TRUE(fails(open_live_motion("tcp:5", {}, motion), Status::kInvalidArgument, {"fifo:PATH"}));
  LiveMotionOptions options;
  options.sigma_m = 0.1;
  EXPECT_TRUE(fails(open_live_motion("udp:0", options, motion), Status::kInvalidArgument, {"--pose-sigma"}));
  ASSERT_TRUE(succeeds(open_live_motion("udp:0", {}, motion)));
  std::unique_ptr<LiveMotion> second;
  EXPECT_TRUE(fails(open_live_motion("udp:" + std::to_string(motion->port()), {}, second), Status::kUnavailable,
                    {"another port"}));
}

TEST(LiveMotion, AFifoOutlivesItsWriters) {
  const test::TempFolder folder;
  const std::string path = (folder / "poses").string();
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  std::unique_ptr<LiveMotion> motion;
  ASSERT_TRUE(succeeds(open_live_motion("fifo:" + path, {}, motion)));
  const auto write = [&path](const std::string& text) {
    const int fd = ::open(path.c_str(), O_WRONLY);
    EXPECT_EQ(::write(fd, text.data(), text.size()), static_cast<ssize_t>(text.size()));
    ::close(fd);
  };
  write(pose_at(1) + "\n" + pose_at(1.02) + "\n1.04 0 0");  // dies in the middle of a line
  ASSERT_TRUE(eventually([&] { return motion->counters().interrupted == 1; }));
  write(pose_at(1.04) + "\n");
  ASSERT_TRUE(eventually([&] { return motion->counters().poses == 3; }));
  EXPECT_EQ(motion->counters().malformed, 1U);
  Motion m;
  EXPECT_TRUE(succeeds(motion->at({1'030 * kMs}, m)));
}

class Udp {
 public:
  explicit Udp(int port) {
    address_.sin_family = AF_INET;
    address_.sin_port = htons(static_cast<std::uint16_t>(port));
    address_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  }
  ~Udp() { ::close(fd_); }
  Udp(const Udp&) = delete;
  Udp& operator=(const Udp&) = delete;
  void send(const std::string& text) const {
    EXPECT_EQ(::sendto(fd_, text.data(), text.size(), 0, reinterpret_cast<const sockaddr*>(&address_), sizeof address_),
              static_cast<ssize_t>(text.size()));
  }

 private:
  int fd_ = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address_{};
};

TEST(LiveMotion, ADatagramHoldsWholeLines) {
  std::unique_ptr<LiveMotion> motion;
  ASSERT_TRUE(succeeds(open_live_motion("udp:0", {}, motion)));
  const Udp udp(motion->port());
  udp.send(pose_at(1) + "\n" + pose_at(1.02));  // the last line needs no end
  udp.send("");
  udp.send(pose_at(1.04) + "\r\n");
  udp.send("1.06 0 0");
  udp.send(std::string(60'000, 'y'));
  udp.send(" 1 0 0 0 1\n");  // no continuation
  ASSERT_TRUE(eventually([&] { return motion->counters().malformed == 3; }));
  EXPECT_EQ(motion->counters().poses, 3U);
  EXPECT_EQ(motion->name(), "poses from udp:0");
}

TEST(LiveMotion, WaitsForThePoseAfterTheFrameButNotForASilentStream) {
  LiveMotionOptions options;
  options.wait_ns = 60'000 * kMs;
  std::unique_ptr<LiveMotion> motion;
  ASSERT_TRUE(succeeds(open_live_motion("udp:0", options, motion)));
  const Udp udp(motion->port());
  udp.send(pose_at(1));
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    udp.send(pose_at(1.02));
  });
  Motion m;
  EXPECT_TRUE(succeeds(motion->at({1'010 * kMs}, m)));
  later.join();
  // Whoever has less time asks for less.
  EXPECT_EQ(motion->at_within(0, {2'000 * kMs}, m).status, Status::kNotFound);
  EXPECT_EQ(motion->at_within(kMs, {2'000 * kMs}, m).status, Status::kNotFound);
  EXPECT_EQ(motion->counters().missing, 2U);

  options.wait_ns = 30 * kMs;
  ASSERT_TRUE(succeeds(open_live_motion("udp:0", options, motion)));
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 200; ++i) EXPECT_EQ(motion->at({i * kMs}, m).status, Status::kNotFound);
  // 200 frames cost one wait, not 200: 6 s.
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(3));
}

TEST(LiveMotion, EndsWhileSomebodyWrites) {
  for (int i = 0; i < 20; ++i) {
    std::unique_ptr<LiveMotion> motion;
    ASSERT_TRUE(succeeds(open_live_motion("udp:0", {}, motion)));
    const Udp udp(motion->port());
    for (int k = 0; k < 20; ++k) udp.send(pose_at(1 + 0.01 * k));
    motion.reset();
  }
}

}  // namespace
}  // namespace accrete::hal
