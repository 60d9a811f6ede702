// Columns of time stamps in seconds, or in nanoseconds by a frequent mistake.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "accrete/hal/stereo_source.h"
#include "text/parse.h"

namespace accrete::hal {

struct StampColumn {
  std::vector<Decimal> values;
  std::vector<std::size_t> lines;  // of the file, for messages

  // Adds a field of a row. Status: kInvalidArgument (not a finite number).
  Outcome add(const std::filesystem::path& path, const Row& row, std::size_t field);

  // Seconds unless one of them is above 1e12 (31,700 years), which is said in a notice: then all are nanoseconds.
  // Status: kInvalidArgument (seconds that no Timestamp holds).
  Outcome convert(const std::filesystem::path& path, std::vector<Timestamp>& stamps,
                  std::vector<std::string>& notices) const;
};

}  // namespace accrete::hal
