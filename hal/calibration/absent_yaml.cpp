// Stands in for yaml_load.cpp in a build without yaml-cpp.
#include "calibration/yaml_file.h"

namespace accrete::hal {

Outcome YamlFile::load(const std::filesystem::path& path) {
  return {Status::kUnsupported,
          path.string() + " is YAML, which this build leaves out: configure with -DACCRETE_WITH_YAML=ON"};
}

}  // namespace accrete::hal
