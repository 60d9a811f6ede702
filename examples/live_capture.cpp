// Live capture to a callback: live_capture CALIBRATION CAMERAS POSES [PAIRS], for instance
//   live_capture stereo.yml v4l2:LEFT,RIGHT udp:5005 300
// CAMERAS also libcamera:LEFT,RIGHT; POSES as docs/reference/live.md has them. Ends after PAIRS, or with the camera.
#include <accrete/accumulator.h>
#include <accrete/hal/libcamera.h>
#include <accrete/hal/live_motion.h>
#include <accrete/hal/second_thread.h>
#include <accrete/hal/v4l2.h>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>

using namespace accrete;

using Callback = std::function<void(const StereoFrame& frame, const Motion& motion)>;

static hal::Outcome open(const std::string& cameras, const std::string& calibration,
                         std::unique_ptr<hal::LiveSource>& source) {
  const std::size_t colon = cameras.find(':'), comma = cameras.find(',');
  if (colon == std::string::npos || comma == std::string::npos || comma < colon)
    return {Status::kInvalidArgument, cameras + ": write v4l2:LEFT,RIGHT or libcamera:LEFT,RIGHT"};
  hal::LibcameraOptions options;
  options.left = cameras.substr(colon + 1, comma - colon - 1);
  options.right = cameras.substr(comma + 1);
  options.calibration = calibration;
  return cameras.compare(0, colon, "libcamera") == 0 ? hal::open_libcamera(options, source)
                                                     : hal::open_v4l2(options, source);
}

// Calls `on_pair` for every pair that has a pose. A pair is lent: its pixels are gone after the call.
static hal::Outcome capture(hal::LiveSource& source, hal::MotionSource& poses, long pairs, const Callback& on_pair) {
  hal::Outcome outcome = source.start();
  for (long n = 0; outcome.ok() && n < pairs; ++n) {
    StereoFrame frame;
    Motion motion;
    outcome = source.acquire(2'000'000'000, frame);
    if (!outcome.ok()) break;
    if (poses.at(frame.t_left, motion).ok()) on_pair(frame, motion);
    source.release();
  }
  source.stop();
  return outcome;
}

int main(int argc, char** argv) {
  if (argc < 4) return std::puts("usage: live_capture CALIBRATION CAMERAS POSES [PAIRS]"), 2;
  std::unique_ptr<hal::LiveSource> source;
  std::unique_ptr<hal::LiveMotion> poses;
  hal::Outcome outcome = open(argv[2], argv[1], source);
  if (outcome.ok()) outcome = hal::open_live_motion(argv[3], {}, poses);
  hal::SecondThread second;  // both images of a pair are searched at once
  const auto accumulator = std::make_unique<Accumulator<>>();
  accumulator->set_pair_runner(second.runner());
  if (outcome.ok()) outcome.status = accumulator->configure(source->rig());
  if (outcome.ok())
    outcome = capture(*source, *poses, argc > 4 ? std::atol(argv[4]) : 300,
                      [&](const StereoFrame& frame, const Motion& motion) {
                        const StepReport report = accumulator->step(frame, motion);
                        std::printf("pair %llu: %s, %u confirmed\n", static_cast<unsigned long long>(frame.sequence),
                                    to_string(report.status), report.confirmed);
                      });
  if (!outcome.ok()) std::fprintf(stderr, "%s: %s\n", to_string(outcome.status), outcome.message.c_str());
  return outcome.ok() ? 0 : 1;
}
