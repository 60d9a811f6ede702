#include "extract/extract.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/angles.h"
#include "base/elementary.h"
#include "extract/localise.h"
#include "extract/normal_flow.h"
#include "extract/side_colours.h"
#include "extract/undistort.h"

namespace accrete::extract {
namespace {

// Keeps the strongest: a heap with the weakest on top, made only once the image holds more than the capacity.
class Budget {
 public:
  explicit Budget(std::span<Primitive2d> out) : out_(out) {}

  // True when `p` was taken in.
  bool offer(const Primitive2d& p) {
    if (count_ < out_.size()) {
      out_[count_++] = p;
      return true;
    }
    if (!heaped_) {
      std::make_heap(out_.begin(), out_.end(), stronger);
      heaped_ = true;
    }
    if (out_.empty() || !stronger(p, out_.front())) return false;
    std::pop_heap(out_.begin(), out_.end(), stronger);
    out_.back() = p;
    std::push_heap(out_.begin(), out_.end(), stronger);
    return true;
  }
  std::size_t finish() {
    if (heaped_)  // back to raster order, so that neighbours in the image are neighbours in memory
      std::sort(out_.begin(), out_.end(), [](const Primitive2d& a, const Primitive2d& b) {
        return a.y_px != b.y_px ? a.y_px < b.y_px : a.x_px < b.x_px;
      });
    return count_;
  }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] bool heaped() const { return heaped_; }
  [[nodiscard]] Primitive2d& operator[](std::size_t i) { return out_[i]; }

 private:
  static bool stronger(const Primitive2d& a, const Primitive2d& b) {
    if (a.amplitude != b.amplitude) return a.amplitude > b.amplitude;
    return a.y_px != b.y_px ? a.y_px < b.y_px : a.x_px < b.x_px;
  }
  std::span<Primitive2d> out_;
  std::size_t count_ = 0;
  bool heaped_ = false;
};

// Two cells may pick the same stretch of edge on both sides of their border: the weaker goes (METHOD 1.4, half a
// pitch).
bool suppressed_by_neighbour(Budget& taken, std::size_t first, const Primitive2d& p, std::size_t& weaker) {
  constexpr float kMinDistance = 0.5F * kPitch;
  for (std::size_t i = taken.count(); i-- > first;) {
    const float dx = taken[i].x_px - p.x_px, dy = taken[i].y_px - p.y_px;
    if (dx * dx + dy * dy >= kMinDistance * kMinDistance) continue;
    weaker = i;
    return true;
  }
  return false;
}

void keep_grey(const ImageView& image, const RowKernels& kernels, Scratch& scratch) {
  const auto w = static_cast<std::size_t>(image.width_px);
  float* grey = scratch.rows.data() + kPadding;  // the filters are done: their rows are free
  for (int y = 0; y < image.height_px; ++y) {
    std::uint8_t* out = scratch.previous.data() + static_cast<std::size_t>(y) * w;
    if (image.format == PixelFormat::kGrey8) {
      std::memcpy(out, image.row(y), w);
    } else {
      load_row(image, Channel::kLuma, y, kernels, grey);
      kernels.round_to_bytes(grey, image.width_px, out);
    }
  }
  scratch.has_previous = true;
}

// Beside `a`, and not farther along it. Edges as near as this displace each other, which their asymmetry says.
bool is_other_edge(const Localised& a, const Localised& b) {
  constexpr float kApart = 2.5F;
  const float dx = b.x_px - a.x_px, dy = b.y_px - a.y_px;
  return std::fabs(dy * a.ux - dx * a.uy) >= kApart;
}

// An edge that was found in chroma is described in the sense of the luma wherever that has one, so that it is the same
// structure in a view in which the luma is strong enough to be taken.
void agree_with_luma(const QuadratureFilter& luma, float min_energy, Localised& edge) {
  const int x = static_cast<int>(std::lround(edge.x_px)), y = static_cast<int>(std::lround(edge.y_px));
  if (luma.energy(y)[x] < min_energy) return;
  const float nx = -edge.uy, ny = edge.ux;
  const float even = luma.even(y)[x], odd = luma.odd_x(y)[x] * nx + luma.odd_y(y)[x] * ny;
  const SineCosine<float> phase = sine_cosine(edge.phase);
  if (even * phase.cosine + odd * phase.sine < 0) edge.phase = wrap_two_pi(edge.phase + kPi);
}

}  // namespace

std::size_t extract(const ImageView& image, const ExtractParams& params, const Alignment& alignment,
                    const RowKernels& kernels, Scratch& scratch, std::span<Primitive2d> out, ExtractCounts& counts) {
  const int width = image.width_px, height = image.height_px;
  const std::size_t floats = quadrature_floats(static_cast<std::size_t>(width));
  QuadratureFilter luma(image, Channel::kLuma, kernels, scratch.rows.first(floats));
  QuadratureFilter chroma(image, Channel::kChroma, kernels, scratch.rows.subspan(floats, floats));
  const bool colour = image.format != PixelFormat::kGrey8;
  const auto advance_to = [&](int y) {
    while (luma.newest() < y && luma.advance()) {
      if (colour) chroma.advance();
    }
  };
  const std::span<Cell> cells = scratch.cells.first(cells_per_band(static_cast<std::size_t>(width)));
  const float threshold = params.min_amplitude * params.min_amplitude;
  Budget budget(out);
  std::size_t previous_band = 0, this_band = 0;  // where in `out` the neighbours of a new primitive begin

  // Takes a cell's candidate in; false: there is no edge. `beside`: the cell's first edge, of which this is no other
  // part.
  const auto finish = [&](const CellWinner& candidate, const Localised* beside, Localised& edge) {
    if (touches_fill(image, candidate.x, candidate.y)) {
      ++counts.refused_fill;
      return false;
    }
    const bool in_luma = candidate.channel == Channel::kLuma;
    const LocaliseOutcome outcome = localise(in_luma ? luma : chroma, candidate.x, candidate.y, params, edge);
    if (outcome != LocaliseOutcome::kOk) {
      counts.refused_dimension += outcome == LocaliseOutcome::kDimension;
      return false;
    }
    if (beside != nullptr && !is_other_edge(*beside, edge)) return true;
    if (!in_luma) agree_with_luma(luma, threshold, edge);
    Primitive2d p;
    p.x_px = edge.x_px;
    p.y_px = edge.y_px;
    p.theta = edge.theta;
    p.amplitude = edge.amplitude;
    std::size_t weaker = 0;
    const bool near = !budget.heaped() && suppressed_by_neighbour(budget, previous_band, p, weaker);
    if (near && budget[weaker].amplitude >= p.amplitude) return true;
    p.confidence_i0d = edge.confidence_i0d;
    p.confidence_i1d = edge.confidence_i1d;
    p.confidence_i2d = edge.confidence_i2d;
    p.sigma_n_px = edge.sigma_n_px;
    p.sigma_theta = edge.sigma_theta;
    p.sigma_phase = edge.sigma_phase;
    const bool step = std::fabs(cos_of(edge.phase)) < kStepLike;
    const SideColours sides = sample_sides(image, edge, step);
    if (step) {  // lines have no dark side
      const float shift = encoding_shift(sides, candidate.channel, params.mixing_width_px);
      p.x_px += shift * edge.uy;
      p.y_px -= shift * edge.ux;
    }
    p.appearance = {edge.phase, sides.left, sides.right};
    p.sigma_colour = sides.sigma;
    if (scratch.has_previous && in_luma) measure_flow(scratch.previous.data(), width, edge, p);
    if (!undistort(*alignment.camera, alignment.R_a_c, alignment.focal_px, p)) {
      ++counts.refused_distortion;
      return true;
    }
    if (near) {
      budget[weaker] = p;
      return true;
    }
    const bool was_full = budget.count() == out.size();
    budget.offer(p);
    counts.refused_capacity += was_full;
    return true;
  };

  for (int band = 0; band * kBand < height; ++band) {
    const int y0 = std::max(band * kBand, kMargin), y1 = std::min((band + 1) * kBand, height - kMargin);
    if (y0 >= y1) continue;
    std::fill(cells.begin(), cells.end(), Cell{});
    for (int y = y0; y < y1; ++y) {
      advance_to(y + 1);
      offer_row(luma, colour ? &chroma : nullptr, y, width, threshold, cells);
    }
    advance_to(std::min(y1 + 4, height - 1));
    previous_band = this_band;
    this_band = budget.count();
    for (const Cell& cell : cells) {
      Localised first, second;
      if (cell.first.score <= 0) continue;
      const bool found = finish(cell.first, nullptr, first);
      if (cell.second.score > 0) finish(cell.second, found ? &first : nullptr, second);
    }
  }
  const std::size_t n = budget.finish();
  counts.primitives = static_cast<std::uint32_t>(n);
  keep_grey(image, kernels, scratch);
  return n;
}

}  // namespace accrete::extract
