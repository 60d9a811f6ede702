// The real recordings: in $ACCRETE_DATA, else where CMake expects them. A test without them is skipped, visibly.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace accrete::test {

inline std::filesystem::path data_folder() {
  const char* chosen = std::getenv("ACCRETE_DATA");
  return chosen != nullptr ? chosen : ACCRETE_TEST_DATA;
}

}  // namespace accrete::test

// Defines `variable` as the folder of the recording `name`.
#define ACCRETE_RECORDING_OR_SKIP(variable, name)                                 \
  const std::filesystem::path variable = ::accrete::test::data_folder() / (name); \
  if (!std::filesystem::is_directory(variable))                                   \
  GTEST_SKIP() << variable << " is not there: set ACCRETE_DATA to the folder of the recordings"
