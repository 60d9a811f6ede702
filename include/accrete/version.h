// The version, in one place: CMake reads it from here.
#pragma once

#define ACCRETE_VERSION_MAJOR 0
#define ACCRETE_VERSION_MINOR 1
#define ACCRETE_VERSION_PATCH 0

namespace accrete {

inline constexpr char kVersion[] = "0.1.0";

}  // namespace accrete
