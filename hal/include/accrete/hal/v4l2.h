// Live stereo from V4L2 (Linux): two cameras, or one that delivers both images in one buffer. What is understood, and
// what happens to whom when a camera is lost: docs/reference/cameras.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "accrete/hal/stereo_source.h"

namespace accrete::hal {

enum class V4l2Layout : std::uint8_t {
  kTwoDevices,
  kSideBySide,         // one device, the left image on the left: twice as wide as an eye
  kSideBySideSwapped,  // the right image on the left
  kTopBottom,          // the left image above: twice as high as an eye
  kInterleaved,        // Y8I: the two images pixel by pixel; as wide as an eye
};

// "two", "sbs", "sbs-swap", "tb", "y8i"
[[nodiscard]] const char* to_string(V4l2Layout layout);

struct V4l2Options {
  // A device: its node (/dev/video0, or 0), a link or a link's name in /dev/v4l/by-id or /dev/v4l/by-path, its bus or
  // its card as V4l2Device has them where only one device has it.
  std::string left;
  std::string right;  // kTwoDevices only; otherwise empty
  V4l2Layout layout = V4l2Layout::kTwoDevices;

  int width_px = 0, height_px = 0;    // of one eye; 0: the calibration's, and without one what the device is set to
  double rate_hz = 0;                 // 0: what the device is set to
  std::string fourcc;                 // "GREY", "YUYV", "MJPG", ...; empty: the first that both devices have
  std::filesystem::path calibration;  // as RecordingOptions; empty: rig() stays empty

  std::int64_t pair_tolerance_ns = 0;  // 0: half a period, at most 8 ms
  int buffers = 4;                     // each device, 3 .. 32

  int warm_up_frames = 15;    // pairs that are left out while exposure and white balance settle, 0 .. 1000
  bool lock_exposure = true;  // then exposure, gain and white balance are fixed, and the left one's copied to the right

  // How long a camera that is gone is looked for, from the moment of its loss; 0: not at all.
  std::int64_t reconnect_timeout_ns = 30'000'000'000;
};

enum class V4l2State : std::uint8_t {
  kStopped,
  kWarmingUp,
  kStreaming,
  kReconnecting,  // a camera is gone; acquire() looks for it
  kLost,          // it did not come back in time: stop() and start() try again
};

[[nodiscard]] const char* to_string(V4l2State state);

// What the time of an image means.
enum class V4l2Clock : std::uint8_t {
  kUnknown,          // nothing arrived yet
  kStartOfExposure,  // CLOCK_MONOTONIC, as uvcvideo declares
  kEndOfFrame,       // CLOCK_MONOTONIC, end of the transfer
  kArrival,          // the driver gave none: CLOCK_MONOTONIC when the buffer was taken, later by an unknown time
};

[[nodiscard]] const char* to_string(V4l2Clock clock);

// Of one device, since the last start().
struct V4l2DeviceStatistics {
  std::string node;  // now; another one, perhaps, after a reconnection
  std::string id;    // by which it is found again; empty: by its node alone
  std::string card, bus;
  std::string fourcc;               // negotiated
  int width_px = 0, height_px = 0;  // of the buffer, negotiated
  double rate_hz = 0;               // negotiated; 0: the driver does not say
  V4l2Clock clock = V4l2Clock::kUnknown;
  std::uint64_t arrived = 0;         // good images
  std::uint64_t dropped = 0;         // by the driver, from gaps in its numbers
  std::uint64_t damaged = 0;         // flagged by the driver, too short, undecodable, or not later than the one before
  std::uint64_t unpaired = 0;        // without a partner within the tolerance
  std::vector<std::string> locked;   // controls that were fixed: "exposure_time_absolute 157"
  std::vector<std::string> notices;  // "it has no gain control: ..."; no error
};

struct V4l2Statistics {
  V4l2State state = V4l2State::kStopped;
  V4l2DeviceStatistics left, right;  // one device for both: right is empty
  std::uint64_t delivered = 0;       // pairs
  std::uint64_t warm_up = 0;         // pairs left out at the start
  std::uint64_t reconnects = 0;      // successful ones
  std::uint64_t gaps = 0;            // pairs that were delivered after a loss of the camera
  bool after_gap = false;            // the last pair that was delivered is one of them; its sequence has the gap, too
  std::int64_t pair_tolerance_ns = 0;
  // t_right - t_left over the delivered pairs, ns.
  std::int64_t skew_min_ns = 0, skew_max_ns = 0;
  double skew_mean_ns = 0;
  std::string loss;  // why the camera was lost last
};

// configure(): devices are opened and the format negotiated; kNotFound (no such device), kUnavailable (busy,
// forbidden), kUnsupported (a format, a size or a layout that the device or this build has not; the sentence says what
// it has), kInvalidArgument (options out of range), and those of the calibration. acquire(): kTimeout with what to look
// at; while a camera is gone kTimeout as well, and kNotFound once reconnect_timeout_ns is over. Memory is bounded by
// the buffers and two images. One thread at a time.
class V4l2Source : public StereoSource {
 public:
  [[nodiscard]] virtual V4l2Statistics statistics() const = 0;
};

// On success `source` is configured: call start() next. On failure it is null. kUnsupported where there is no V4L2.
[[nodiscard]] Outcome open_v4l2(const V4l2Options& options, std::unique_ptr<V4l2Source>& source);

struct V4l2Size {
  int width_px = 0, height_px = 0;
  int max_width_px = 0, max_height_px = 0;  // of a device that scales; otherwise the same
  std::vector<double> rates_hz;             // highest first; empty: the driver does not say
};

struct V4l2Format {
  std::string fourcc;
  std::string description;
  bool understood = false;  // by this build
  std::vector<V4l2Size> sizes;
};

struct V4l2Device {
  std::string node;  // /dev/video0
  std::string id;    // name in /dev/v4l/by-id, else in /dev/v4l/by-path, else empty
  std::string card, driver, bus;
  std::vector<V4l2Format> formats;
  std::string problem;  // why it could not be asked, otherwise empty
  // The layout that its sizes suggest: two images wide (or high) is no single camera.
  V4l2Layout likely_layout = V4l2Layout::kTwoDevices;
};

// The nodes that capture video, in the order of their numbers; those that only carry metadata are left out. Empty where
// there is no V4L2.
[[nodiscard]] std::vector<V4l2Device> list_v4l2_devices();

}  // namespace accrete::hal
