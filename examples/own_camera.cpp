// A camera that the library does not know: its own thread pushes pairs of images, this one takes them out and
// accumulates. The newest pairs stay when this thread is too slow; nobody who pushes ever waits.
#include <accrete/accumulator.h>
#include <accrete/hal/push_source.h>
#include <accrete/hal/synthetic.h>

#include <cstdio>
#include <memory>
#include <thread>

using namespace accrete;

constexpr std::int64_t kPatience_ns = 30'000'000'000;  // an emulator renders a pair in some seconds

int main() {
  // Instead of a camera's kit and a robot: a rendered box, and where it is.
  std::unique_ptr<hal::StereoSource> kit;
  std::unique_ptr<hal::MotionSource> robot;
  hal::SyntheticOptions options;
  options.frames = 12;
  options.degrees_per_frame = 3;
  if (!hal::open_synthetic("box-plain", options, kit, robot).ok() || !kit->configure().ok() || !kit->start().ok())
    return 1;

  hal::PushSettings settings;
  settings.rig = kit->rig();  // the calibration
  settings.capacity = 12;     // so many pairs may wait
  hal::PushSource source(settings);
  if (!source.configure().ok() || !source.start().ok()) return 1;
  std::thread camera([&] {
    StereoFrame grabbed;
    while (kit->acquire(0, grabbed).ok()) {
      if (source.push(grabbed) != Status::kOk) std::puts("a pair was refused");  // and counted; otherwise copied
      kit->release();
    }
    source.close();  // no more will come: acquire() below ends when all are out
  });

  const auto accumulator = std::make_unique<Accumulator<>>();
  Status status = accumulator->configure(source.rig());
  StereoFrame frame;
  Motion motion;
  while (status == Status::kOk && source.acquire(kPatience_ns, frame).ok()) {
    if (robot->at(frame.t_left, motion).ok()) status = accumulator->step(frame, motion).status;
    source.release();
  }
  camera.join();
  const std::size_t edges = accumulator->model().size();
  std::printf("%zu edges from %llu pairs, %llu overwritten\n", edges,
              static_cast<unsigned long long>(source.pushed().delivered),
              static_cast<unsigned long long>(source.pushed().overwritten));
  return status == Status::kOk && edges > 50 ? 0 : 2;
}
