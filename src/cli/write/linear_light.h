// Colours as shares of the light, which is what a surface reflects, out of colours as images encode them.
#pragma once

#include "accrete/model.h"
#include "accrete/params.h"

namespace accrete::cli {

enum class Encoding : unsigned char { kLinear, kSrgb };

// That of the images that `params` was made for: nothing is mixed before linear images are encoded.
[[nodiscard]] Encoding encoding_of(const Params& params);

// The same primitive with both colours in linear light, and their covariances carried along to first order.
[[nodiscard]] Primitive3d in_linear_light(const Primitive3d& primitive, Encoding encoding);

}  // namespace accrete::cli
