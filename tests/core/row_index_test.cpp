// Lookups by row and by cell, against a search through everything.
#include "stereo/row_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "associate/grid.h"
#include "core/picture.h"

namespace accrete {
namespace {

using test::Dice;

std::vector<Primitive2d> random_places(std::size_t n, double reach, std::uint64_t seed) {
  Dice dice(seed);
  std::vector<Primitive2d> out(n);
  for (Primitive2d& p : out) {
    p.aligned.x_px = static_cast<float>(dice.uniform(-reach, reach));
    p.aligned.y_px = static_cast<float>(dice.uniform(-reach, reach));
  }
  return out;
}

TEST(RowIndex, finds_whatever_lies_between_two_rows) {
  // 5000 px is beyond the index: what lies there shares the last row, and must still be found.
  for (const double reach : {1.0, 300.0, 5000.0})
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{700}}) {
      const auto primitives = random_places(n, reach, n + 1);
      std::vector<std::uint16_t> order(n);
      std::vector<std::uint32_t> begin(stereo::kRows + 1, 77U);
      stereo::RowIndex index{order, begin};
      for (int twice = 0; twice < 2; ++twice) index.build(primitives);
      std::set<std::uint16_t> once(order.begin(), order.end());
      EXPECT_EQ(once.size(), n);
      for (const float y : {-4900.0F, -20.0F, -1.0F, 0.0F, 0.5F, 17.0F, 4000.0F})
        for (const float half : {0.0F, 4.5F, 60.0F}) {
          std::set<std::size_t> found;
          for (const std::uint16_t i : index.between(y - half, y + half)) {
            EXPECT_TRUE(found.insert(i).second);
            const float d = std::fabs(primitives[i].aligned.y_px - y);
            if (std::fabs(primitives[i].aligned.y_px) < 2000) {
              EXPECT_LE(d, half + 2 * stereo::kRowHeight);
            }
          }
          for (std::size_t i = 0; i < n; ++i)
            if (std::fabs(primitives[i].aligned.y_px - y) <= half) {
              EXPECT_TRUE(found.count(i)) << y;
            }
        }
    }
}

TEST(Grid, finds_whatever_lies_in_a_square) {
  for (const double reach : {1.0, 300.0, 5000.0}) {
    const auto primitives = random_places(900, reach, 5);
    std::vector<std::uint16_t> order(primitives.size());
    std::vector<std::uint32_t> begin(associate::Grid::kCells + 1, 99U);
    associate::Grid grid{begin, order};
    for (int twice = 0; twice < 2; ++twice) grid.build(primitives);
    Dice dice(6);
    for (int k = 0; k < 100; ++k) {
      const auto x = static_cast<float>(dice.uniform(-reach, reach)),
                 y = static_cast<float>(dice.uniform(-reach, reach));
      const auto radius = static_cast<float>(dice.uniform(0, 30));
      std::set<std::size_t> found;
      grid.near(x, y, radius, [&](std::uint16_t i) { EXPECT_TRUE(found.insert(i).second); });
      for (std::size_t i = 0; i < primitives.size(); ++i) {
        const LineElement& e = primitives[i].aligned;
        if (std::fabs(e.x_px - x) <= radius && std::fabs(e.y_px - y) <= radius) {
          EXPECT_TRUE(found.count(i));
        }
      }
    }
  }
}

}  // namespace
}  // namespace accrete
