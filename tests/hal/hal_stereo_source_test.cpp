// The checked public layer, on a back-end that does nothing of its own.
#include <gtest/gtest.h>

#include "outcome_matchers.h"

namespace accrete::hal {
namespace {

class Fake final : public StereoSource {
 public:
  Outcome configure_outcome, start_outcome;
  Outcome next;  // of the next acquire
  int released = 0, stopped = 0;

 private:
  Outcome do_configure() override { return configure_outcome; }
  Outcome do_start() override { return start_outcome; }
  Outcome do_acquire(std::int64_t /*timeout_ns*/, StereoFrame& frame) override {
    static const std::uint8_t pixel = 7;
    frame.left = frame.right = {&pixel, 1, 1, 1, PixelFormat::kGrey8};
    return next;
  }
  void do_release() override { ++released; }
  void do_stop() override { ++stopped; }
};

using State = StereoSource::SourceState;

TEST(StereoSource, GoesThroughItsStates) {
  Fake source;
  StereoFrame frame;
  EXPECT_EQ(source.state(), State::kClosed);
  EXPECT_TRUE(fails(source.start(), Status::kUnavailable, {"configure()"}));
  EXPECT_TRUE(fails(source.acquire(0, frame), Status::kUnavailable, {"start()"}));
  ASSERT_TRUE(succeeds(source.configure()));
  EXPECT_EQ(source.state(), State::kConfigured);
  EXPECT_TRUE(fails(source.configure(), Status::kUnavailable, {"configured already"}));
  source.stop();
  EXPECT_EQ(source.stopped, 0);
  ASSERT_TRUE(succeeds(source.start()));
  EXPECT_EQ(source.state(), State::kStreaming);
  EXPECT_TRUE(fails(source.start(), Status::kUnavailable, {"streaming already"}));
  source.stop();
  EXPECT_EQ(source.state(), State::kConfigured);
  EXPECT_EQ(source.stopped, 1);
  ASSERT_TRUE(succeeds(source.start()));
}

TEST(StereoSource, StaysWhereItIsWhenAHookFails) {
  Fake source;
  source.configure_outcome = {Status::kNotFound, "no camera"};
  EXPECT_TRUE(fails(source.configure(), Status::kNotFound, {"no camera"}));
  EXPECT_EQ(source.state(), State::kClosed);
  source.configure_outcome = {};
  ASSERT_TRUE(succeeds(source.configure()));
  source.start_outcome = {Status::kUnavailable, "busy"};
  EXPECT_TRUE(fails(source.start(), Status::kUnavailable, {"busy"}));
  EXPECT_EQ(source.state(), State::kConfigured);
}

TEST(StereoSource, LendsOneFrameAtATimeAndCounts) {
  Fake source;
  StereoFrame frame;
  ASSERT_TRUE(succeeds(source.configure()));
  ASSERT_TRUE(succeeds(source.start()));
  source.release();  // nothing is out
  EXPECT_EQ(source.released, 0);
  ASSERT_TRUE(succeeds(source.acquire(0, frame)));
  EXPECT_TRUE(frame.left.valid());
  EXPECT_TRUE(fails(source.acquire(0, frame), Status::kUnavailable, {"release()"}));
  source.release();
  source.release();
  EXPECT_EQ(source.released, 1);
  EXPECT_TRUE(fails(source.acquire(-1, frame), Status::kInvalidArgument, {"timeout"}));
  source.next = {Status::kDataLoss, "torn"};
  EXPECT_TRUE(fails(source.acquire(0, frame), Status::kDataLoss, {"torn"}));
  EXPECT_FALSE(frame.left.valid());  // nothing was lent
  source.next = {Status::kTimeout, "late"};
  EXPECT_FALSE(source.acquire(0, frame).ok());
  source.next = {};
  ASSERT_TRUE(succeeds(source.acquire(0, frame)));
  EXPECT_EQ(source.counters().delivered, 2U);
  EXPECT_EQ(source.counters().dropped, 1U);
  source.stop();  // takes the frame back
  EXPECT_EQ(source.released, 2);
}

}  // namespace
}  // namespace accrete::hal
