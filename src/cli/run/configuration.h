// The effective configuration of a run: what was asked for and what was found, in one tree.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "cli/run/engine.h"
#include "cli/run/input.h"
#include "cli/run/options.h"

namespace accrete::cli {

// Keys of the tunables are those of params.h, which --set takes.
[[nodiscard]] nlohmann::ordered_json configuration(const RunOptions& options, const Input& input, const Engine& engine);

// A tree of objects, arrays of scalars or of such arrays, and scalars, as YAML with two blanks a level.
[[nodiscard]] std::string to_yaml(const nlohmann::ordered_json& tree);

}  // namespace accrete::cli
