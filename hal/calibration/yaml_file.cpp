#include "calibration/yaml_file.h"

#include <algorithm>
#include <cmath>

#include "text/parse.h"
#include "text/sentence.h"

namespace accrete::hal {

const YamlEntry* YamlFile::find(std::initializer_list<std::string_view> names) const {
  for (const std::string_view name : names)
    for (const YamlEntry& entry : entries_)
      if (entry.key == name) return &entry;
  return nullptr;
}

std::string YamlFile::where(const YamlEntry& entry) const { return at_line(path_, entry.line) + ": " + entry.key; }

Outcome YamlFile::numbers(const YamlEntry& entry, std::vector<double>& out) const {
  out.clear();
  for (const std::string& text : entry.values) {
    double value = 0;
    if (!parse(text, value) || !std::isfinite(value))
      return {Status::kInvalidArgument, where(entry) + ": value " + std::to_string(out.size() + 1) + " is " +
                                            in_quotes(text) + ", not a finite number: calibrate again, or correct it"};
    out.push_back(value);
  }
  return {};
}

}  // namespace accrete::hal
