// The push interface: who waits for whom, what is dropped, and that every borrowed image is released once.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>
#include <vector>

#include "accrete/hal/push_source.h"
#include "outcome_matchers.h"

namespace accrete::hal {
namespace {

constexpr std::int64_t kMs = 1'000'000;

struct Image {
  std::array<std::uint8_t, 4 * 3> bytes{};

  explicit Image(int value) { bytes.fill(static_cast<std::uint8_t>(value)); }
  [[nodiscard]] ImageView view() const { return {bytes.data(), 4, 3, 4, PixelFormat::kGrey8}; }
};

Status push(PushSource& source, int value, std::int64_t t_ns, PushSource::Release release = {}) {
  const Image left(value), right(value + 100);
  StereoFrame frame;
  frame.left = left.view();
  frame.right = right.view();
  frame.t_left = frame.t_right = {t_ns};
  return source.push(frame, std::move(release));
}

PushSettings small(std::size_t capacity = 2) {
  PushSettings s;
  s.capacity = capacity;
  return s;
}

void begin(PushSource& source) {
  EXPECT_TRUE(succeeds(source.configure()));
  EXPECT_TRUE(succeeds(source.start()));
}

TEST(PushSource, CopiesAndDeliversInOrder) {
  PushSource source(small(3));
  begin(source);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(push(source, i, i * kMs), Status::kOk);  // the images are gone by now
  StereoFrame frame;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(succeeds(source.acquire(0, frame)));
    EXPECT_EQ(frame.left.row(2)[3], i);
    EXPECT_EQ(frame.right.row(0)[0], i + 100);
    EXPECT_EQ(frame.sequence, static_cast<std::uint64_t>(i));
    EXPECT_EQ(frame.t_left.ns, i * kMs);
    source.release();
  }
  EXPECT_EQ(source.acquire(kMs, frame).status, Status::kTimeout);
}

TEST(PushSource, KeepsTheNewestAndCountsTheOldest) {
  PushSource source(small());
  begin(source);
  for (int i = 0; i < 7; ++i) EXPECT_EQ(push(source, i, i * kMs), Status::kOk);
  StereoFrame frame;
  ASSERT_TRUE(succeeds(source.acquire(0, frame)));
  EXPECT_EQ(frame.sequence, 5U);  // the gap says how many are missing
  EXPECT_EQ(source.counters().dropped, 5U);
  EXPECT_EQ(source.pushed().overwritten, 5U);
  // What is lent stays as it is, whatever comes.
  for (int i = 7; i < 20; ++i) EXPECT_EQ(push(source, i, i * kMs), Status::kOk);
  EXPECT_EQ(frame.left.data[0], 5);
}

TEST(PushSource, RefusesWhatCannotBeUsed) {
  PushSettings settings = small();
  settings.rig.left.width_px = 640;
  settings.rig.left.height_px = 480;
  PushSource sized(settings);
  begin(sized);
  EXPECT_EQ(push(sized, 1, 0), Status::kInvalidArgument);
  EXPECT_EQ(sized.push({}), Status::kInvalidArgument);
  PushSource closed(small());
  EXPECT_EQ(push(closed, 1, 0), Status::kUnavailable);
  PushSource source(small());
  begin(source);
  EXPECT_EQ(push(source, 1, 5), Status::kOk);
  EXPECT_EQ(push(source, 2, 5), Status::kInvalidArgument);
  source.close();
  EXPECT_EQ(push(source, 3, 6), Status::kUnavailable);
  EXPECT_EQ(source.pushed().refused, 2U);
  PushSource none(small(0));
  EXPECT_TRUE(fails(none.configure(), Status::kInvalidArgument, {"capacity"}));
}

TEST(PushSource, ClosingEndsTheStreamAfterWhatWaits) {
  PushSource source(small());
  begin(source);
  EXPECT_EQ(push(source, 1, 1), Status::kOk);
  source.close();
  StereoFrame frame;
  ASSERT_TRUE(succeeds(source.acquire(0, frame)));
  source.release();
  EXPECT_EQ(source.acquire(1'000 * kMs, frame).status, Status::kEndOfStream);
}

TEST(PushSource, ReleasesEveryBorrowedImageOnce) {
  int released = 0;
  const auto count = [&released] { ++released; };
  {
    PushSource source(small());
    begin(source);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(push(source, i, i, count), Status::kOk);
    EXPECT_EQ(released, 1);  // overwritten
    StereoFrame frame;
    ASSERT_TRUE(succeeds(source.acquire(0, frame)));
    source.release();
    EXPECT_EQ(released, 2);
    EXPECT_EQ(push(source, 0, 0, count), Status::kInvalidArgument);
    EXPECT_EQ(released, 3);  // refused
    EXPECT_EQ(source.push_left(Image(1).view(), {100}, count), Status::kOk);
    ASSERT_TRUE(succeeds(source.acquire(0, frame)));
  }
  EXPECT_EQ(released, 5);  // the lent one, and the one without a partner
}

TEST(PushSource, BorrowedPixelsAreNotCopied) {
  PushSource source(small());
  begin(source);
  const Image left(1), right(2);
  StereoFrame frame;
  frame.left = left.view();
  frame.right = right.view();
  EXPECT_EQ(source.push(frame, [] {}), Status::kOk);
  StereoFrame got;
  ASSERT_TRUE(succeeds(source.acquire(0, got)));
  EXPECT_EQ(got.left.data, left.bytes.data());
  EXPECT_EQ(got.right.data, right.bytes.data());
}

TEST(PushSource, JoinsSingleImagesByTime) {
  PushSource source(small(4));
  begin(source);
  EXPECT_EQ(source.push_left(Image(1).view(), {0}), Status::kOk);
  EXPECT_EQ(source.push_left(Image(2).view(), {33 * kMs}), Status::kOk);
  EXPECT_EQ(source.push_right(Image(102).view(), {35 * kMs}), Status::kOk);  // belongs to the second
  EXPECT_EQ(source.push_right(Image(104).view(), {100 * kMs}), Status::kOk);
  EXPECT_EQ(source.push_right(Image(103).view(), {90 * kMs}), Status::kInvalidArgument);  // not in order
  EXPECT_EQ(source.push_left(Image(4).view(), {95 * kMs}), Status::kOk);
  StereoFrame frame;
  ASSERT_TRUE(succeeds(source.acquire(0, frame)));
  EXPECT_EQ(frame.left.data[0], 2);
  EXPECT_EQ(frame.right.data[0], 102);
  EXPECT_EQ(frame.t_right - frame.t_left, 2 * kMs);
  EXPECT_EQ(source.counters().unpaired, 1U);
  source.release();
  ASSERT_TRUE(succeeds(source.acquire(0, frame)));
  EXPECT_EQ(frame.right.data[0], 104);
}

TEST(PushSource, ImagesWithoutPartnersDoNotPileUp) {
  PushSource source(small(3));
  begin(source);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(source.push_left(Image(1).view(), {i * 33 * kMs}), Status::kOk);
  EXPECT_EQ(source.pushed().unpaired, 997U);
}

// Also meant for ThreadSanitizer.
TEST(PushSource, ManyThreadsPushAndOneTakes) {
  constexpr int kThreads = 3, kEach = 400;
  PushSource source(small(4));
  begin(source);
  std::atomic<std::int64_t> clock{1};
  std::atomic<int> released{0}, borrowed{0};
  std::vector<std::thread> threads;
  threads.reserve(kThreads + 1);
  for (int n = 0; n < kThreads; ++n)
    threads.emplace_back([&, n] {
      static const Image left(7), right(8);  // borrowed: they outlive the source's interest
      for (int i = 0; i < kEach; ++i) {
        StereoFrame frame;
        frame.left = left.view();
        frame.right = right.view();
        frame.t_left = frame.t_right = {clock++};
        if ((i + n) % 2 == 0) {
          (void)source.push(frame);
        } else {
          ++borrowed;
          (void)source.push(frame, [&released] { ++released; });
        }
      }
    });
  threads.emplace_back([&] {
    for (int i = 0; i < kEach; ++i) {
      (void)source.push_left(Image(1).view(), {clock += 100 * kMs});
      (void)source.pushed();
    }
  });
  std::thread closer([&] {
    for (std::thread& thread : threads) thread.join();
    source.close();
  });
  StereoFrame frame;
  std::uint64_t taken = 0;
  std::int64_t last = 0;
  for (Outcome o; (o = source.acquire(10'000 * kMs, frame)).ok(); source.release()) {
    EXPECT_GT(frame.t_left.ns, last);
    last = frame.t_left.ns;
    EXPECT_EQ(frame.left.data[11], 7);
    ++taken;
  }
  closer.join();
  const PushCounters c = source.pushed();
  EXPECT_EQ(c.delivered, taken);
  EXPECT_EQ(c.pushed, c.delivered + c.overwritten);
  EXPECT_EQ(c.pushed + c.refused, static_cast<std::uint64_t>(kThreads * kEach));
  EXPECT_EQ(released, borrowed);
}

}  // namespace
}  // namespace accrete::hal
