// A model that an earlier run saved, taken up: `run --resume`, and the file that `run --save-model` leaves.
#pragma once

#include <filesystem>
#include <string>

#include "accrete/saved_model.h"
#include "cli/run/engine.h"

namespace accrete::cli {

inline constexpr const char* kModelFile = "model.accrete";

class SavedModel {
 public:
  // `path`: the file, or the folder of results that holds it. Throws Failure(kInput): not there, or refused, and why.
  explicit SavedModel(const std::filesystem::path& path);

  [[nodiscard]] const SavedModelInfo& info() const { return info_; }
  // The profile that it was saved with. Throws Failure(kUsage) where `wanted` is another one.
  [[nodiscard]] Capacity capacity(Capacity wanted) const;
  // Into an engine that is configured; where `first` is no later than its last frame, on a new clock. Throws
  // Failure(kInput): refused.
  void into(Engine& engine, Timestamp first) const;
  // For describe().
  [[nodiscard]] std::string line() const;

 private:
  std::filesystem::path file_;
  std::string bytes_;
  SavedModelInfo info_;
};

// The file's content.
[[nodiscard]] std::string saved(const Engine& engine);

}  // namespace accrete::cli
