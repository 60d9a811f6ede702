// A recording that a test has opened, and its frames played to the end.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "accrete/hal/recording.h"

namespace accrete::hal {

struct Opened {
  std::unique_ptr<StereoSource> source;
  std::unique_ptr<MotionSource> motion;
  RecordingInfo info;
  Outcome outcome;

  explicit Opened(const std::filesystem::path& path, const RecordingOptions& options = {}) {
    outcome = open_recording(path, options, source, motion, info);
  }
};

struct Played {
  std::vector<std::uint64_t> sequences;
  std::vector<std::int64_t> times_ns;
  std::vector<int> first_pixels;
  std::vector<std::string> losses;  // sentences of kDataLoss
  Status end = Status::kOk;

  explicit Played(StereoSource& source) {
    if (!source.start().ok()) return;
    StereoFrame frame;
    while (true) {
      Outcome o = source.acquire(0, frame);
      if (o.ok()) {
        sequences.push_back(frame.sequence);
        times_ns.push_back(frame.t_left.ns);
        first_pixels.push_back(frame.left.data[0]);
        source.release();
      } else if (o.status == Status::kDataLoss) {
        losses.push_back(std::move(o.message));
      } else {
        end = o.status;
        return;
      }
    }
  }
};

}  // namespace accrete::hal
