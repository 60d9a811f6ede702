// accrete record: what a source delivers, into a folder that this and other programs read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "cli/failure.h"
#include "cli/run/options.h"

namespace CLI {
class App;
}

namespace accrete::cli {

struct RecordOptions {
  RunOptions run;  // what is read, and how
  std::filesystem::path folder;
  int buffer_mb = 128;
  std::int64_t sync_period_ns = 1'000'000'000;
  std::int64_t duration_ns = 0;  // 0: to the end, or until interrupted
  bool quiet = false;
};

// Beside those of RunFlags::add_input.
class RecordFlags {
 public:
  void add(CLI::App& app);
  // After parsing; `run` holds the flags of the input. Throws Failure(kUsage).
  [[nodiscard]] RecordOptions options(const RunOptions& run) const;

 private:
  RecordOptions plain_;
  std::string sync_, duration_;
};

// Throws Failure: kInput (as run), kOutput (a recording is there already, or the folder cannot be written).
[[nodiscard]] ExitStatus record_command(const RecordOptions& options);

}  // namespace accrete::cli
