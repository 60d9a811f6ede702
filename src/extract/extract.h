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
#include "extract/cells.h"
#include "extract/quadrature.h"

namespace accrete::extract {

// All the memory that extraction of one camera's images needs.
struct Scratch {
  std::span<float> rows;             // kChannels * quadrature_floats(width)
  std::span<Cell> cells;             // cells_per_band(width)
  std::span<std::uint8_t> previous;  // width * height: the previous image's grey levels
  bool has_previous = false;
};
inline constexpr std::size_t kChannels = 2;

struct Alignment {
  const Camera* camera;
  Mat3 R_a_c;
  double focal_px;
};

// Writes at most out.size() primitives, the strongest ones where there are more, in raster order of their cells, and
// returns their number. Preconditions: image.valid(), its size is the camera's, scratch as large as said above.
std::size_t extract(const ImageView& image, const ExtractParams& params, const Alignment& alignment,
                    const RowKernels& kernels, Scratch& scratch, std::span<Primitive2d> out, ExtractCounts& counts);

}  // namespace accrete::extract
