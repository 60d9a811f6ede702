// A pair of fake cameras, and what their pixels ought to be.
#pragma once

#include "fake_kernel.h"
#include "outcome_matchers.h"
#include "v4l2/open.h"

namespace accrete::hal {

inline constexpr std::int64_t kSecond = 1'000'000'000;

struct Rig {
  FakeKernel kernel;
  std::shared_ptr<FakeCamera> left = kernel.add("/dev/video0", 1), right = kernel.add("/dev/video2", 2);
  LiveOptions options;
  std::unique_ptr<LiveSource> source;

  Rig() {
    left->card = "Left";
    right->card = "Right";
    right->first_after_ns += 4'000'000;
    kernel.add("/dev/video1", 9)->metadata = true;  // as UVC: the second node of the left one
    kernel.nodes["/dev/video1"]->card = "Left";
    kernel.links["/dev/v4l/by-id/usb-left"] = "/dev/video0";
    kernel.links["/dev/v4l/by-path/port-2"] = "/dev/video2";
    options.left = "/dev/video0";
    options.right = "/dev/video2";
    options.warm_up_frames = 0;
    options.lock_exposure = false;
  }
  Outcome open() { return v4l2::open(kernel, options, source); }
  Outcome open_and_start() {
    Outcome o = open();
    return o.ok() ? source->start() : o;
  }
  Outcome acquire(StereoFrame& frame, std::int64_t timeout_ns = kSecond) { return source->acquire(timeout_ns, frame); }
};

// The number of the image that the pixels of a grey view are, -1: of none, or of another camera.
inline int image_number(const FakeCamera& camera, const ImageView& view, std::size_t first_byte = 0) {
  for (int n = 0; n < 256; ++n) {
    bool all = true;
    for (int y = 0; all && y < view.height_px; ++y)
      for (int x = 0; all && x < view.width_px; ++x) {
        const std::size_t at = first_byte + static_cast<std::size_t>(y) * camera.stride() + static_cast<std::size_t>(x);
        all = view.row(y)[x] == camera.pattern(static_cast<std::uint32_t>(n), 0, at);
      }
    if (all) return n;
  }
  return -1;
}

}  // namespace accrete::hal
