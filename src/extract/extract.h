// 2D-primitives of one image, in one pass over its pixels (docs/math/extraction.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "accrete/camera.h"
#include "accrete/image.h"
#include "accrete/params.h"
#include "accrete/primitive.h"
#include "accrete/step_report.h"
#include "extract/quadrature.h"

namespace accrete::extract {

// Cells of the sampling lattice: bricks, which tile like hexagons. 6 px is twice the band-pass's line/edge bifurcation
// distance rounded up (METHOD 1.4); 5 rows is 6 sin 60 degrees.
inline constexpr int kPitch = 6;
inline constexpr int kBand = 5;
inline constexpr int kMargin = 7;  // px at the border in which nothing is extracted: kernel, sampling and colour reach

struct CellWinner {
  float energy;
  std::int16_t x, y;
};

// All the memory that extraction of one camera's images needs.
struct Scratch {
  std::span<float> rows;             // quadrature_floats(width)
  std::span<CellWinner> cells;       // cells_per_band(width)
  std::span<std::uint8_t> previous;  // width * height: the previous image's grey levels
  bool has_previous = false;
};
[[nodiscard]] constexpr std::size_t cells_per_band(std::size_t width) { return width / kPitch + 2; }

struct Alignment {
  const Camera* camera;
  Mat3 R_a_c;
  double focal_px;
};

// Writes at most out.size() primitives, the strongest ones where there are more, in raster order of their cells, and
// returns their number. Preconditions: image.valid(), its size is the camera's, scratch as large as said above.
std::size_t extract(const ImageView& image, const ExtractParams& params, const Alignment& alignment, Scratch& scratch,
                    std::span<Primitive2d> out, ExtractCounts& counts);

}  // namespace accrete::extract
