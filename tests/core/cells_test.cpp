// What a cell of the lattice keeps: two edges where the filter tells them apart, and a stand-in for a corner.
#include "extract/cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/picture.h"
#include "extract/localise.h"

namespace accrete {
namespace {

using namespace test;
using extract::Cell;
using extract::CellWinner;
using extract::kBand;
using extract::kMargin;
using extract::kPitch;

constexpr int kWidth = 96, kHeight = 80;

// The value of a bar whose edges are `apart` px from each other, at the distance d from its middle.
double bar(double d, double apart, double blur) {
  return 50 + 150 * smooth_step(d + apart / 2, blur) * smooth_step(apart / 2 - d, blur);
}
double energy_of_bar(double x, double apart, double blur) {
  const auto& k = extract::kKernels;
  double sum = k.smooth[0], even = 0, odd = 0;
  for (int i = 1; i <= extract::kRadius; ++i) sum += 2 * double{k.smooth[i]};
  for (int i = -extract::kRadius; i <= extract::kRadius; ++i) {
    const int j = std::abs(i);
    const double v = bar(x + i, apart, blur);
    even += (double{k.gauss1[j]} - double{k.gauss2[j]}) * v;
    odd += sum * double{k.odd[j]} * (i < 0 ? -v : v);
  }
  return even * even + odd * odd;
}
// How far apart the energy's maxima are; 0: there is one, in the middle, as for a line.
double between_maxima(double apart, double blur) {
  double best = 0;
  for (double x = 0; x < 5; x += 0.01)
    if (energy_of_bar(x, apart, blur) > energy_of_bar(best, apart, blur) + 1e-3) best = x;
  return 2 * best;
}

// Along one direction the filter is two kernels of one dimension, so which edges it tells apart can be calculated.
TEST(Cells, from_3_4_px_the_filter_tells_two_edges_apart_and_from_4_px_by_half_a_pitch) {
  for (const double blur : {0.3, 0.5, 0.7}) {
    EXPECT_EQ(between_maxima(3.3, blur), 0) << blur;
    EXPECT_GT(between_maxima(3.6, blur), 2) << blur;
    EXPECT_LT(between_maxima(3.6, blur), 0.5 * kPitch) << blur;
    EXPECT_GT(between_maxima(4, blur), 0.5 * kPitch - 0.05) << blur;
  }
}

Picture paint_bar(bool upright, double middle, double apart, double blur) {
  return paint_grey(kWidth, kHeight, [&](double x, double y) { return bar((upright ? x : y) - middle, apart, blur); });
}

struct Counts {
  int first = 0, second = 0, others = 0;
};
Counts edges_of(const Picture& p, bool upright, double middle, double apart) {
  Extractor extractor(kWidth, kHeight);
  Counts n;
  for (const Primitive2d& e : extractor(p)) {
    const double d = double{upright ? e.x_px : e.y_px} - middle;
    if (std::fabs(d + apart / 2) < 0.4)
      ++n.first;
    else if (std::fabs(d - apart / 2) < 0.4)
      ++n.second;
    else
      ++n.others;
  }
  return n;
}

TEST(Cells, both_edges_of_a_bar_are_found_in_every_cell_at_every_offset) {
  // Bands that images of kHeight rows have between the margins, and cells that a row has.
  constexpr int kBands = (kHeight - kMargin - 1) / kBand - kMargin / kBand + 1;
  constexpr int kCells = (kWidth - 2 * kMargin) / kPitch;
  for (const double blur : {0.3, 0.7})
    for (const double apart : {4.0, 4.5, 5.0, 6.0})
      for (int k = 0; k < 24; ++k)
        for (const bool upright : {true, false}) {
          const double middle = 36 + 0.25 * k;
          const Counts n = edges_of(paint_bar(upright, middle, apart, blur), upright, middle, apart);
          const int least = upright ? kBands : kCells;
          EXPECT_GE(n.first, least) << blur << ' ' << apart << ' ' << middle << ' ' << upright;
          EXPECT_GE(n.second, least) << blur << ' ' << apart << ' ' << middle << ' ' << upright;
          EXPECT_EQ(n.others, 0) << blur << ' ' << apart << ' ' << middle << ' ' << upright;
        }
}

TEST(Cells, edges_that_the_filter_does_not_tell_apart_are_one_line) {
  for (int k = 0; k < 24; ++k)
    for (const bool upright : {true, false}) {
      const double middle = 36 + 0.25 * k;  // in the exact middle of a row both odd parts are 0, without an axis
      Extractor extractor(kWidth, kHeight);
      const auto found = extractor(paint_bar(upright, middle, 3, 0.5));
      EXPECT_GE(found.size(), 10U);
      for (const Primitive2d& e : found) {
        EXPECT_NEAR(upright ? e.x_px : e.y_px, middle, 0.3);
        EXPECT_LT(std::fabs(e.appearance.phase), 0.3F);
      }
    }
}

TEST(Cells, one_straight_edge_is_about_one_primitive_a_pitch) {
  double length = 0;
  std::size_t found = 0;
  for (int k = 0; k < 90; ++k) {
    const Line line{kWidth / 2 + 0.13 * k, kHeight / 2 + 0.29, k * 3.14159265358979 / 90};
    const Picture p =
        paint_grey(kWidth, kHeight, [&](double x, double y) { return 50 + 150 * smooth_step(line.side(x, y), 0.7); });
    const auto inside = [&](double x, double y) {
      return x >= kMargin && y >= kMargin && x < kWidth - kMargin && y < kHeight - kMargin;
    };
    for (double s = -100; s < 100; s += 0.1)
      length += 0.1 * inside(line.x + s * std::cos(line.theta), line.y + s * std::sin(line.theta));
    Extractor extractor(kWidth, kHeight);
    found += extractor(p).size();
  }
  const double per_pitch = static_cast<double>(found) * kPitch / length;
  RecordProperty("per_pitch", std::to_string(per_pitch));
  EXPECT_GT(per_pitch, 0.8);
  EXPECT_LT(per_pitch, 1.2);
}

// The cells of a band, as extraction makes them, and the filter as it then is.
template <class Visit>
void each_cell(const Picture& p, const ExtractParams& params, const Visit& visit) {
  std::vector<float> rows(extract::quadrature_floats(kWidth));
  extract::QuadratureFilter filter(p.view(), extract::Channel::kLuma, kernels(InstructionSet::kBest).rows, rows);
  const auto advance_to = [&](int y) {
    while (filter.newest() < y && filter.advance()) {
    }
  };
  for (int band = 0; band * kBand < kHeight; ++band) {
    const int y0 = std::max(band * kBand, kMargin), y1 = std::min((band + 1) * kBand, kHeight - kMargin);
    if (y0 >= y1) continue;
    std::vector<Cell> cells(extract::cells_per_band(kWidth));
    for (int y = y0; y < y1; ++y) {
      advance_to(y + 1);
      extract::offer_row(filter, nullptr, y, kWidth, params.min_amplitude * params.min_amplitude, cells);
    }
    advance_to(std::min(y1 + 4, kHeight - 1));
    for (std::size_t i = 0; i < cells.size(); ++i) visit(filter, band, static_cast<int>(i), cells[i]);
  }
}

TEST(Cells, keep_the_better_of_two_that_lie_apart_in_their_own_bounds) {
  Dice dice(1);
  const Picture p = paint_grey(kWidth, kHeight, [&](double, double) { return dice.uniform(0, 255); });
  int both = 0;
  each_cell(p, {}, [&](const extract::QuadratureFilter&, int band, int index, const Cell& cell) {
    const int left = index * kPitch - (band % 2 != 0 ? kPitch / 2 : 0);
    for (const CellWinner& w : {cell.first, cell.second}) {
      if (w.score <= 0) continue;
      EXPECT_EQ(w.y / kBand, band);
      EXPECT_GE(w.x, left);
      EXPECT_LT(w.x, left + kPitch);
    }
    EXPECT_GE(cell.first.score, cell.second.score);
    if (cell.second.score <= 0) return;
    ++both;
    EXPECT_GE(std::hypot(cell.first.x - cell.second.x, cell.first.y - cell.second.y), 0.5 * kPitch);
  });
  EXPECT_GT(both, 50);
}

TEST(Cells, the_second_candidate_stands_in_where_the_first_is_a_corner) {
  ExtractParams params;
  params.mixing_width_px = 0;  // positions are those of localise()
  int stood_in = 0, expected = 0;
  for (int k = 0; k < 30; ++k) {
    const double cx = 40 + 0.23 * k, cy = 36 + 0.31 * k;
    const Picture p = paint_grey(kWidth, kHeight, [&](double x, double y) {
      return 50 + 150 * smooth_step(x - cx, 0.7) * smooth_step(y - cy, 0.7);
    });
    Extractor extractor(kWidth, kHeight);
    const auto found = extractor(p, params);
    each_cell(p, params, [&](const extract::QuadratureFilter& filter, int, int, const Cell& cell) {
      extract::Localised first, second;
      if (cell.first.score <= 0 || cell.second.score <= 0) return;
      if (localise(filter, cell.first.x, cell.first.y, params, first) != extract::LocaliseOutcome::kDimension) return;
      if (localise(filter, cell.second.x, cell.second.y, params, second) != extract::LocaliseOutcome::kOk) return;
      ++expected;
      const auto is_there = [&](float within) {
        return std::any_of(found.begin(), found.end(), [&](const Primitive2d& e) {
          return std::hypot(e.x_px - second.x_px, e.y_px - second.y_px) < within && e.amplitude >= second.amplitude;
        });
      };
      stood_in += is_there(0.1F);
      EXPECT_TRUE(is_there(0.5F * kPitch)) << "neither it nor a stronger neighbour " << k;
    });
  }
  RecordProperty("expected", expected);
  RecordProperty("stood_in", stood_in);
  EXPECT_GE(expected, 10);
  EXPECT_GE(stood_in, 0.8 * expected);
}

}  // namespace
}  // namespace accrete
