// 2D-primitives of one moment that were not found by accrete in images: another extractor's, or recorded measurements.
#pragma once

#include <span>

#include "accrete/primitive.h"
#include "accrete/timestamp.h"

namespace accrete {

// Of the raw images of the rig; `aligned` need not be filled in. Borrowed for the duration of one step.
struct ObservedFrame {
  std::span<const Primitive2d> left;
  std::span<const Primitive2d> right;
  Timestamp t;
};

}  // namespace accrete
