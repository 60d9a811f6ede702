#include <exception>

#include "accrete/hal/recording.h"
#include "motion/find.h"
#include "replay/replay_source.h"
#include "text/sentence.h"

namespace accrete::hal {
namespace {

Outcome check(const RecordingOptions& options) {
  // Below a frame in a quarter of an hour or above a megahertz it is a slip of the pen.
  if (options.rate_hz && !(*options.rate_hz >= 1e-3 && *options.rate_hz <= 1e6))
    return {Status::kInvalidArgument,
            "--fps: " + number(*options.rate_hz) + " is no frame rate: give 0.001 to 1000000 Hz"};
  return check_pose_options(options);
}

Outcome open(const std::filesystem::path& path, const RecordingOptions& options, std::unique_ptr<StereoSource>& source,
             std::unique_ptr<MotionSource>& motion, RecordingInfo& info) {
  if (Outcome o = check(options); !o.ok()) return o;
  auto replay = std::make_unique<ReplaySource>(path, options);
  Outcome o = replay->configure();
  info = replay->info();
  if (!o.ok()) return o;
  if (!options.ignore_poses)
    o = open_poses(replay->layout(), options, replay->calibration(), replay->list(), motion, info);
  if (!o.ok()) {
    motion.reset();
    if (options.require_poses) return o;
    info.warnings.push_back(std::move(o.message));
  }
  source = std::move(replay);
  return {};
}

}  // namespace

Outcome open_recording(const std::filesystem::path& path, const RecordingOptions& options,
                       std::unique_ptr<StereoSource>& source, std::unique_ptr<MotionSource>& motion,
                       RecordingInfo& info) {
  source.reset();
  motion.reset();
  info = {};
  try {
    return open(path, options, source, motion, info);
  } catch (const std::exception& e) {  // out of memory, or a file system that plays tricks
    source.reset();
    motion.reset();
    return {Status::kDataLoss, path.string() + " cannot be read: " + e.what()};
  }
}

}  // namespace accrete::hal
