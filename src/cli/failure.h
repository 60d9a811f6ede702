// How the program ends, and the one exception it throws: a sentence for the user with the exit status that goes with
// it.
#pragma once

#include <stdexcept>
#include <string>

namespace accrete::cli {

// docs/reference/program.md explains each to users.
enum class ExitStatus : int {
  kOk = 0,
  kNothing = 1,       // ran, but nothing was accumulated, or the self-test missed a threshold
  kUsage = 2,         // the command line is wrong (also what shells and CLI11 use)
  kPartial = 3,       // results are there, but frames of the recording could not be used
  kInput = 4,         // recording, calibration, poses or truth cannot be read at all
  kOutput = 5,        // results cannot be written
  kFault = 6,         // doctor: something is wrong with the rig
  kInterrupted = 130  // Ctrl-C (128 + SIGINT, as shells report it); the results so far are there
};

// Says what, where and what to do.
class Failure : public std::runtime_error {
 public:
  Failure(ExitStatus status, const std::string& sentence) : std::runtime_error(sentence), status_(status) {}

  [[nodiscard]] ExitStatus status() const { return status_; }

 private:
  ExitStatus status_;
};

}  // namespace accrete::cli
