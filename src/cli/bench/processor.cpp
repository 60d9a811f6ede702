#include "cli/bench/processor.h"

#include <fstream>

namespace accrete::cli {

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  std::string model, family, number;
  for (std::string line; std::getline(file, line) && !line.empty();) {
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos) continue;
    const std::string value = line.substr(colon + 2);
    if (line.starts_with("model name") || line.starts_with("Model")) model = value;
    if (line.starts_with("cpu family")) family = value;
    if (line.starts_with("model\t")) number = value;
  }
  if (model.empty()) return "unknown processor";
  return family.empty() ? model : model + " (family " + family + ", model " + number + ")";
}

}  // namespace accrete::cli
