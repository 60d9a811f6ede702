// Core and hardware layer: a few frames of the synthetic scene go through. Every public struct crosses the border
// between code of two instruction sets here.
#include <accrete/accumulator.h>
#include <accrete/hal/synthetic.h>

#include <cstdio>
#include <memory>

int main() {
  using namespace accrete;
  std::unique_ptr<hal::StereoSource> stereo;
  std::unique_ptr<hal::MotionSource> motion;
  hal::SyntheticOptions options;
  options.degrees_per_frame = 3;
  options.frames = 12;
  if (!hal::open_synthetic("box-plain", options, stereo, motion).ok() || !stereo->configure().ok() ||
      !stereo->start().ok())
    return 1;
  const auto accumulator = std::make_unique<Accumulator<>>();
  if (accumulator->configure(stereo->rig()) != Status::kOk) return 2;
  StereoFrame frame;
  Motion given;
  while (stereo->acquire(0, frame).ok()) {
    if (!motion->at(frame.t_left, given).ok() || accumulator->step(frame, given).status != Status::kOk) return 3;
    stereo->release();
  }
  const ModelView model = accumulator->model();
  int near = 0;
  for (std::size_t i = 0; i < model.slots(); ++i) {
    if (model.state(i) != State::kConfirmed) continue;
    const Primitive3d p = model.at(i);
    const auto& x = p.geometry.position;
    near += x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < 0.09F * 0.09F ? 1 : 0;  // the box and a little more
  }
  std::printf("%zu primitives, %d confirmed at the box\n", model.size(), near);
  return near > 50 ? 0 : 4;
}
