// How deep the core goes: a step runs on a stack of its own that was painted before, and what is left of the paint
// tells.
#include <pthread.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <type_traits>
#include <vector>

#include "kernels/kernels.h"
#include "memory/replay.h"

namespace accrete {
namespace {

// docs/memory.md promises it for optimised code: a frame of tests/house/stack_usage.py for 4, 8 or 16 lanes, and as
// much as the largest of the others for what calls it.
std::size_t bound(int lanes) {
  constexpr std::size_t kKiB = 1024;
  return (lanes == 16 ? 22 : 16) * kKiB;
}

class PaintedStack {
 public:
  // Runs `what` on it and returns the bytes that were ever used, those of the thread itself included.
  template <class What>
  std::size_t depth(What&& what) {
    std::fill(memory_.begin(), memory_.end(), Page{});
    pthread_attr_t attributes;
    pthread_t thread;
    const auto enter = [](void* argument) -> void* {
      (*static_cast<std::remove_reference_t<What>*>(argument))();
      return nullptr;
    };
    EXPECT_EQ(pthread_attr_init(&attributes), 0);
    EXPECT_EQ(pthread_attr_setstack(&attributes, memory_.data(), bytes()), 0);
    EXPECT_EQ(pthread_create(&thread, &attributes, enter, &what), 0);
    EXPECT_EQ(pthread_join(thread, nullptr), 0);
    pthread_attr_destroy(&attributes);
    const auto* first = reinterpret_cast<const std::byte*>(memory_.data());
    std::size_t untouched = 0;  // it grows downwards
    while (untouched < bytes() && first[untouched] == kPaint) ++untouched;
    EXPECT_GT(untouched, 0U) << "deeper than this test can see";
    return bytes() - untouched;
  }

 private:
  static constexpr std::byte kPaint{0xa5};
  struct alignas(4096) Page {
    Page() { std::fill(std::begin(bytes), std::end(bytes), kPaint); }
    std::byte bytes[4096];
  };
  [[nodiscard]] std::size_t bytes() const { return memory_.size() * sizeof(Page); }

  std::vector<Page> memory_{256};
};

template <class Limits>
std::size_t deepest_step(InstructionSet set, int frames) {
  PaintedStack stack;
  const std::size_t thread_itself = stack.depth([] {});
  const auto accumulator = std::make_unique<Accumulator<Limits>>(set);
  std::size_t deepest = 0;
  bool configured = false;
  test::replay("box", frames, [&](const StereoRig& rig, const StereoFrame& frame, const Motion& motion) {
    StepReport report;
    const std::size_t depth = stack.depth([&] {
      if (!configured) configured = accumulator->configure(rig) == Status::kOk;
      report = accumulator->step(frame, motion);
    });
    deepest = std::max(deepest, depth - thread_itself);
    ASSERT_EQ(report.status, Status::kOk);
  });
  return deepest;
}

TEST(Stack, OfAStepIsBounded) {
  const std::size_t deepest = deepest_step<SmallLimits>(InstructionSet::kBest, 30);
  EXPECT_GT(deepest, 1000U);
  EXPECT_LE(deepest, bound(kernels(InstructionSet::kBest).lanes));
}

// What tests/house/installed_sizes.py compares with docs/memory.md.
TEST(Stack, OfAStepDoesNotGrowWithTheLimits) {
  const std::size_t small = deepest_step<SmallLimits>(InstructionSet::kBaseline, 8);
  const std::size_t usual = deepest_step<DefaultLimits>(InstructionSet::kBaseline, 8);
  const std::size_t large = deepest_step<LargeLimits>(InstructionSet::kBaseline, 8);
  for (const std::size_t deepest : {small, usual, large}) EXPECT_LE(deepest, bound(4));
  std::printf("stack SmallLimits %zu\nstack DefaultLimits %zu\nstack LargeLimits %zu\n", small, usual, large);
}

}  // namespace
}  // namespace accrete
