// Left and right images by their times: with jitter, losses, a camera that delivers late, and a clock that wraps.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "camera/pairer.h"

namespace accrete::hal::camera {
namespace {

constexpr std::int64_t kPeriod = 33'000'000, kTolerance = 8'000'000;

// What two cameras send, in the order of arrival; `slot` is the number of the moment.
struct Arrival {
  Eye eye;
  Waiting image;
  std::int64_t arrives_ns;
};

struct Outcomes {
  std::vector<Pair> pairs;
  std::size_t unpaired = 0, waiting = 0;
};

Outcomes run(std::vector<Arrival> arrivals, Pairer pairer) {
  std::stable_sort(arrivals.begin(), arrivals.end(),
                   [](const Arrival& a, const Arrival& b) { return time_difference(a.arrives_ns, b.arrives_ns) < 0; });
  Outcomes o;
  for (const Arrival& a : arrivals) {
    pairer.add(a.eye, a.image);
    Pair pair;
    while (pairer.next(pair)) o.pairs.push_back(pair);
    for (const Eye eye : {Eye::kLeft, Eye::kRight}) {
      o.unpaired += pairer.unpaired(eye).size();
      pairer.unpaired(eye).clear();
    }
  }
  o.waiting = pairer.waiting(Eye::kLeft).size() + pairer.waiting(Eye::kRight).size();
  return o;
}

std::vector<Arrival> both(int frames, std::int64_t begin, std::int64_t skew, std::int64_t jitter,
                          std::int64_t right_late, const std::set<int>& no_left, const std::set<int>& no_right) {
  std::mt19937 random(3);
  std::uniform_int_distribution<std::int64_t> noise(-jitter, jitter);
  std::vector<Arrival> arrivals;
  for (int i = 0; i < frames; ++i) {
    const auto at = [begin, i](std::int64_t shift) {  // wraps as a clock does
      return static_cast<std::int64_t>(static_cast<std::uint64_t>(begin) +
                                       static_cast<std::uint64_t>(i * kPeriod + shift));
    };
    const std::int64_t l = at(noise(random)), r = at(skew + noise(random));
    const auto number = static_cast<std::uint64_t>(i);
    if (!no_left.contains(i)) arrivals.push_back({Eye::kLeft, {i, l, number}, at(1'000'000)});
    if (!no_right.contains(i)) arrivals.push_back({Eye::kRight, {i, r, number}, at(2'000'000 + right_late)});
  }
  return arrivals;
}

void expect_true_pairs(const Outcomes& o, std::size_t pairs, std::size_t alone) {
  EXPECT_EQ(o.pairs.size(), pairs);
  EXPECT_EQ(o.unpaired + o.waiting, alone);
  for (const Pair& pair : o.pairs) EXPECT_EQ(pair.left.slot, pair.right.slot);
  for (std::size_t i = 1; i < o.pairs.size(); ++i) EXPECT_GT(o.pairs[i].left.slot, o.pairs[i - 1].left.slot);
}

TEST(V4l2Pairer, PairsByTimeInSpiteOfJitter) {
  expect_true_pairs(run(both(200, 0, 3'000'000, 2'000'000, 0, {}, {}), {kTolerance, 2}), 200, 0);
}

TEST(V4l2Pairer, ALostImageCostsItsPartnerAlone) {
  expect_true_pairs(run(both(50, 0, 0, 1'000'000, 0, {3, 10, 11, 12}, {20, 49}), {kTolerance, 2}), 44, 6);
}

TEST(V4l2Pairer, ACameraThatDeliversLateLosesNothing) {
  expect_true_pairs(run(both(50, 0, 1'000'000, 0, kPeriod, {}, {}), {kTolerance, 2}), 50, 0);
  // Beyond the depth it can only lose, but never pairs wrongly.
  const Outcomes o = run(both(50, 0, 1'000'000, 0, 5 * kPeriod, {}, {}), {kTolerance, 2});
  for (const Pair& pair : o.pairs) EXPECT_EQ(pair.left.slot, pair.right.slot);
  EXPECT_LE(o.waiting, 4U);
}

TEST(V4l2Pairer, TheClockMayWrap) {
  expect_true_pairs(run(both(50, INT64_MAX - 20 * kPeriod, 2'000'000, 1'000'000, 0, {5}, {30}), {kTolerance, 2}), 48,
                    2);
}

TEST(V4l2Pairer, BeyondTheToleranceThereIsNoPair) {
  Pairer pairer(kTolerance, 2);
  const Outcomes o = run(both(20, 0, 12'000'000, 0, 0, {}, {}), {kTolerance, 2});
  EXPECT_TRUE(o.pairs.empty());
  pairer.add(Eye::kLeft, {0, 0, 0});
  pairer.add(Eye::kRight, {1, kTolerance + 1, 0});
  Pair pair;
  EXPECT_FALSE(pairer.next(pair));
  EXPECT_EQ(pairer.nearest_miss_ns(), kTolerance + 1);
  pairer.add(Eye::kLeft, {2, 2 * kTolerance + 1, 1});  // exactly the tolerance
  EXPECT_TRUE(pairer.next(pair));
  EXPECT_EQ(pair.left.slot, 2);
}

TEST(V4l2Pairer, TheNearerOfTwoCandidatesIsTaken) {
  Pairer pairer(kTolerance, 4);
  pairer.add(Eye::kLeft, {0, 0, 0});
  pairer.add(Eye::kLeft, {1, 6'000'000, 1});
  pairer.add(Eye::kRight, {2, 7'000'000, 0});
  Pair pair;
  ASSERT_TRUE(pairer.next(pair));
  EXPECT_EQ(pair.left.slot, 1);
  EXPECT_EQ(pairer.unpaired(Eye::kLeft).size(), 1U);
}

TEST(V4l2Pairer, ASilentCameraHoldsNoMoreThanTheDepth) {
  Pairer pairer(kTolerance, 2);
  for (int i = 0; i < 100; ++i) pairer.add(Eye::kLeft, {i, i * kPeriod, 0});
  EXPECT_EQ(pairer.waiting(Eye::kLeft).size(), 2U);
  EXPECT_EQ(pairer.waiting(Eye::kLeft).front().slot, 98);
  EXPECT_EQ(pairer.unpaired(Eye::kLeft).size(), 98U);
}

// What is nearest and farthest from each other in 64 bits.
TEST(V4l2Pairer, HostileTimesAreNoOverflow) {
  Pairer pairer(kTolerance, 2);
  pairer.add(Eye::kLeft, {0, INT64_MIN, 0});
  pairer.add(Eye::kRight, {0, 0, 0});
  Pair pair;
  EXPECT_FALSE(pairer.next(pair));
  pairer.clear();
  pairer.add(Eye::kLeft, {0, INT64_MAX, 0});
  pairer.add(Eye::kRight, {0, INT64_MIN, 0});  // one nanosecond later, when the clock wraps
  EXPECT_TRUE(pairer.next(pair));
}

}  // namespace
}  // namespace accrete::hal::camera
