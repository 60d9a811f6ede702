// The core takes nothing from the heap, ever: not when it is configured, not in a step, not when the model is read.
#include <cstdlib>
#include <memory>
#include <vector>

#include "memory/allocations.h"
#include "memory/replay.h"

namespace accrete {
namespace {

using test::allocations;

TEST(Allocations, AreCountedWhicheverWayTheyAreMade) {
  const auto taken = [](auto&& what) {
    const std::uint64_t before = allocations();
    what();
    return allocations() - before;
  };
  int* volatile plain = nullptr;
  EXPECT_EQ(taken([&] { plain = new int(1); }), 1U);
  delete plain;
  struct alignas(128) Wide {
    char bytes[128];
  };
  Wide* volatile wide = nullptr;
  EXPECT_EQ(taken([&] { wide = new Wide(); }), 1U);
  delete wide;
  void* volatile raw = nullptr;
  EXPECT_EQ(taken([&] { raw = std::malloc(10); }), 1U);
  EXPECT_EQ(taken([&] { raw = std::realloc(raw, 10000); }), 1U);
  std::free(raw);
  EXPECT_EQ(taken([&] { raw = std::calloc(3, 3); }), 1U);
  std::free(raw);
  std::vector<int> list;
  EXPECT_EQ(taken([&] { list.resize(100); }), 1U);
  EXPECT_EQ(taken([] {}), 0U);
}

// Everything that the interface offers, around and inside a whole recording. Returns what the last step said.
template <class Limits>
StepReport expect_none(const char* scene, int frames, StepReport& sum) {
  const auto accumulator = std::make_unique<Accumulator<Limits>>();
  std::uint64_t taken = 0;
  StepReport last;
  float read = 0;
  bool configured = false;
  test::replay(scene, frames, [&](const StereoRig& rig, const StereoFrame& frame, const Motion& motion) {
    const std::uint64_t before = allocations();
    if (!configured) configured = accumulator->configure(rig) == Status::kOk;
    last = accumulator->step(frame, motion);
    const ModelView model = accumulator->model();
    for (std::size_t i = 0; i < model.slots(); ++i)
      if (model.state(i) != State::kFree) read += model.at(i).existence;
    taken += allocations() - before;
    ASSERT_EQ(last.status, Status::kOk);
    sum.merged += last.merged;
    sum.evicted += last.evicted;
    sum.left.refused_capacity += last.left.refused_capacity;
    sum.birth_refused_capacity += last.birth_refused_capacity;
    sum.deleted_existence += last.deleted_existence;
  });
  const std::uint64_t before = allocations();
  accumulator->reset();
  taken += allocations() - before;
  EXPECT_EQ(taken, 0U);
  EXPECT_GT(read, 0);
  return last;
}

TEST(Allocations, NoneInAWholeReplay) {
  StepReport sum;
  const StepReport last = expect_none<SmallLimits>("box", 60, sum);
  EXPECT_GT(last.confirmed + last.preserved, 200U);  // it did what it is for
  EXPECT_GT(sum.merged, 0U);
  EXPECT_GT(sum.deleted_existence, 0U);
}

TEST(Allocations, NoneWhenEverythingIsFull) {
  StepReport sum;
  const StepReport last = expect_none<test::TightLimits>("box", 20, sum);
  EXPECT_LE(last.tentative + last.confirmed + last.preserved, test::TightLimits::kMaxPrimitives3d);
  EXPECT_GT(sum.left.refused_capacity, 0U);
  EXPECT_GT(sum.evicted + sum.birth_refused_capacity, 0U);
}

TEST(Allocations, NoneWhenTheCamerasMove) {
  StepReport sum;
  const StepReport last = expect_none<SmallLimits>("room", 10, sum);
  EXPECT_GT(last.confirmed, 0U);
}

}  // namespace
}  // namespace accrete
