// All bits of a model in one number: two machines that print the same have computed the same.
#pragma once

#include <cstdint>
#include <span>

#include "accrete/model.h"

namespace accrete::cli {

[[nodiscard]] std::uint64_t model_hash(std::span<const Primitive3d> primitives);

}  // namespace accrete::cli
