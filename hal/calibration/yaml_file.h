// The top level of a YAML file as plain text values: the one place that knows yaml-cpp, and where its exceptions end.
#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "accrete/hal/stereo_source.h"

namespace accrete::hal {

struct YamlEntry {
  std::string key;
  std::size_t line = 0;
  bool map = false;                 // a map that is no matrix: only its key is known
  std::vector<std::string> values;  // one for a scalar; a sequence or matrix row after row
  int rows = 0, cols = 0;           // where the file states them
};

class YamlFile {
 public:
  // More values than this under one key are no calibration.
  static constexpr std::size_t kMaxValues = 64;

  // Reads maps of scalars, sequences (nested up to twice) and matrices {rows, cols, data}; "%YAML:1.0" is accepted.
  // Status: those of read_text; kDataLoss (no YAML, no map, a key that occurs twice), kUnsupported (this build leaves
  // YAML out).
  Outcome load(const std::filesystem::path& path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  // The first of `names` that is there, otherwise null.
  [[nodiscard]] const YamlEntry* find(std::initializer_list<std::string_view> names) const;
  // "FILE, line 7: M1"
  [[nodiscard]] std::string where(const YamlEntry& entry) const;
  // Status: kInvalidArgument when a value is no finite number.
  Outcome numbers(const YamlEntry& entry, std::vector<double>& out) const;

 private:
  std::filesystem::path path_;
  std::vector<YamlEntry> entries_;
};

}  // namespace accrete::hal
