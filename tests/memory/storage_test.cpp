// storage_bytes promises to the public header what the pipeline needs: enough, and hardly more.
#include <gtest/gtest.h>

#include "accumulator/pipeline.h"

namespace accrete {
namespace {

std::size_t needed(const Capacities& capacities) {
  Workspace counted;
  return (sizeof(Pipeline) + 63) / 64 * 64 + cut(nullptr, capacities, counted);
}

template <class Limits>
void expect_tight() {
  constexpr Capacities c = Accumulator<Limits>::kCapacities;
  EXPECT_GE(storage_bytes(c), needed(c)) << "the coefficients in accumulator.h promise too little";
  EXPECT_LE(static_cast<double>(storage_bytes(c)), 1.03 * static_cast<double>(needed(c)))
      << "the coefficients in accumulator.h waste memory";
}

TEST(Storage, IsEnoughAndNotMuchMore) {
  expect_tight<SmallLimits>();
  expect_tight<DefaultLimits>();
  expect_tight<LargeLimits>();
}

// Each capacity alone at its largest and at its smallest: the promise is made for whatever a user writes.
TEST(Storage, IsEnoughForAnyLimits) {
  const std::size_t image[] = {32, 33, 640, 641, 8192}, flat[] = {16, 17, 300, 65535}, deep[] = {16, 48, 4096, 1 << 20};
  for (const std::size_t width : image)
    for (const std::size_t height : image)
      for (const std::size_t n2 : flat)
        for (const std::size_t n3 : deep)
          for (const std::size_t matches : {n2, 4 * n2}) {
            const Capacities c{width, height, n2, n3, matches};
            ASSERT_GE(storage_bytes(c), needed(c)) << width << " x " << height << ", " << n2 << ", " << n3;
          }
}

}  // namespace
}  // namespace accrete
