// A camera as vivid and uvcvideo were seen to behave: silently another size, times a constant after the start, numbers
// of its own, and faults on request. Its pixels say which image of which camera they are.
#pragma once

#include <linux/videodev2.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace accrete::hal {

enum class FrameFault : std::uint8_t {
  kNone,
  kDropped,   // the driver lost it: its number is missing
  kNotSent,   // the camera never sent it: no number is missing
  kFlagged,   // V4L2_BUF_FLAG_ERROR
  kShort,     // fewer bytes than an image has
  kSameTime,  // the time of the one before
};

struct FakeControl {
  std::int32_t value = 0, min = 0, max = 0;
  std::uint32_t flags = 0;
};

struct FakeCamera {
  // What it is.
  std::string card = "Fake camera", driver = "uvcvideo", bus = "usb-1";
  std::uint8_t id = 0;  // in the pixels
  bool multiplanar = false, metadata = false;
  std::map<std::uint32_t, std::vector<std::pair<std::uint32_t, std::uint32_t>>> sizes{{V4L2_PIX_FMT_GREY, {{32, 16}}}};
  std::uint32_t padding = 8;  // bytes after each row
  std::map<std::uint32_t, FakeControl> controls;
  std::int64_t period_ns = 33'000'000;
  std::int64_t first_after_ns = 20'000'000;  // after STREAMON
  std::int64_t delivered_after_ns = 0;       // after the time that an image bears
  std::int64_t jitter_ns = 0;                // of that time, alternating
  std::uint32_t first_sequence = 0;
  std::uint32_t clock = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  std::int64_t clock_offset_ns = 0;
  std::uint32_t quantization = V4L2_QUANTIZATION_DEFAULT;
  std::uint32_t field = V4L2_FIELD_NONE;
  std::function<std::vector<std::uint8_t>(std::uint32_t number)> payload;  // instead of the pattern
  std::map<std::uint64_t, FrameFault> faults;                              // by the number of the image since STREAMON
  bool present = true, broken = false;  // broken: a fatal streaming error, until the stream is started again

  // What it does.
  std::uint32_t width = 32, height = 16, fourcc = V4L2_PIX_FMT_GREY;
  std::uint32_t rate_hz = 30;
  bool streaming = false;
  int owner = -1;  // the file that has the buffers
  struct Buffer {
    std::vector<std::vector<std::uint8_t>> planes;
    std::vector<std::size_t> used;
    bool queued = false;
    std::uint32_t sequence = 0, flags = 0;
    std::int64_t t_ns = 0;
  };
  std::vector<Buffer> buffers;
  std::deque<std::uint32_t> queued, done;
  std::uint64_t number = 0;  // of the next image
  std::uint32_t lost = 0;    // numbers that were taken back
  std::int64_t started_ns = 0, last_t_ns = 0;
  int mappings = 0;

  [[nodiscard]] std::uint32_t bits() const {  // of a pixel in the first plane
    switch (fourcc) {
      case V4L2_PIX_FMT_YUYV:
      case V4L2_PIX_FMT_UYVY:
      case V4L2_PIX_FMT_Y10:
      case V4L2_PIX_FMT_Y12:
      case V4L2_PIX_FMT_Y16:
      case V4L2_PIX_FMT_Y8I:
        return 16;
      case V4L2_PIX_FMT_RGB24:
      case V4L2_PIX_FMT_BGR24:
        return 24;
      default:
        return 8;
    }
  }
  [[nodiscard]] std::uint32_t stride() const { return width * bits() / 8 + padding; }
  [[nodiscard]] std::uint32_t plane_count() const { return fourcc == V4L2_PIX_FMT_NV12M ? 2 : 1; }
  [[nodiscard]] std::uint32_t plane_bytes(std::uint32_t plane) const {
    if (fourcc == V4L2_PIX_FMT_NV12M && plane == 1) return stride() * (height / 2);
    return fourcc == V4L2_PIX_FMT_NV12 || fourcc == V4L2_PIX_FMT_YUV420 ? stride() * height * 3 / 2 : stride() * height;
  }
  // Byte `at` of plane `plane` of image `number`.
  [[nodiscard]] std::uint8_t pattern(std::uint32_t image, std::uint32_t plane, std::size_t at) const {
    return static_cast<std::uint8_t>(id * 37 + image * 7 + plane * 91 + at % stride() + 3 * (at / stride()));
  }

  [[nodiscard]] std::int64_t due_ns(std::uint64_t image) const {
    return started_ns + first_after_ns + static_cast<std::int64_t>(image) * period_ns;
  }
  // Delivers every image that is due.
  void advance(std::int64_t now_ns) {
    if (!present || broken || !streaming) return;
    for (; due_ns(number) + delivered_after_ns <= now_ns; ++number) {
      const auto found = faults.find(number);
      const FrameFault fault = found == faults.end() ? FrameFault::kNone : found->second;
      if (fault == FrameFault::kNotSent) ++lost;
      if (fault == FrameFault::kNotSent || fault == FrameFault::kDropped || queued.empty()) continue;
      Buffer& b = buffers[queued.front()];
      done.push_back(queued.front());
      queued.pop_front();
      b.sequence = static_cast<std::uint32_t>(first_sequence + number - lost);
      b.flags = clock | (fault == FrameFault::kFlagged ? V4L2_BUF_FLAG_ERROR : 0U);
      b.t_ns = static_cast<std::int64_t>(  // it may wrap
          static_cast<std::uint64_t>(due_ns(number) + (number % 2 == 0 ? jitter_ns : -jitter_ns)) +
          static_cast<std::uint64_t>(clock_offset_ns));
      if (fault == FrameFault::kSameTime) b.t_ns = last_t_ns;
      last_t_ns = b.t_ns;
      fill(b, fault);
    }
  }
  void fill(Buffer& b, FrameFault fault) {
    const auto image = static_cast<std::uint32_t>(number);
    for (std::uint32_t p = 0; p < b.planes.size(); ++p) {
      std::vector<std::uint8_t>& bytes = b.planes[p];
      b.used[p] = bytes.size();
      if (payload) {
        const std::vector<std::uint8_t> data = payload(image);
        b.used[p] = std::min(data.size(), bytes.size());
        std::copy_n(data.begin(), b.used[p], bytes.begin());
      } else {
        for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = pattern(image, p, i);
      }
      if (fault == FrameFault::kShort) b.used[p] /= 2;
    }
  }
  void end_stream() {
    streaming = broken = false;
    queued.clear();
    done.clear();
    for (Buffer& b : buffers) b.queued = false;
  }
  void free_buffers() {
    end_stream();
    buffers.clear();
    owner = -1;
  }
};

}  // namespace accrete::hal
