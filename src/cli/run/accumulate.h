// The main loop: every frame of an input into an engine.
#pragma once

#include <cstdint>
#include <functional>

#include "accrete/motion.h"
#include "accrete/stereo_frame.h"
#include "cli/run/engine.h"
#include "cli/run/input.h"
#include "cli/run/progress.h"
#include "cli/run/record.h"

namespace accrete::cli {

// One frame that has just been accumulated, or was held out; borrowed for the call.
struct FrameContext {
  std::uint64_t number = 0;
  const StereoFrame& frame;
  const Motion& motion;
  Engine& engine;
  const RunRecord& run;
};

struct LoopHooks {
  std::function<void(Timestamp)> first;                // before the first frame that has a pose, with its time
  std::function<bool(std::uint64_t number)> hold_out;  // true: the frame goes to `held_out` instead of the engine
  std::function<void(const FrameContext&)> held_out;
  std::function<void(const FrameContext&)> accumulated;
};

// Runs until the input ends or the user interrupts. Frames that cannot be used are recorded and warned about; the
// others are used. Precondition: input.motion is there. Throws Failure(kInput) when the source cannot start.
[[nodiscard]] RunRecord accumulate(Input& input, Engine& engine, const RunOptions& options, Progress& progress,
                                   const LoopHooks& hooks = {});

// Frames that the loop will deliver, 0 when unknown: for Progress.
[[nodiscard]] std::uint64_t expected_frames(const Input& input, const RunOptions& options);

}  // namespace accrete::cli
