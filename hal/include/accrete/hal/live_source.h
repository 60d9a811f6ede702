// Cameras that deliver now: what V4L2 and libcamera have in common. What is understood, and what happens to whom when a
// camera is lost: docs/reference/cameras.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "accrete/hal/stereo_source.h"

namespace accrete::hal {

enum class StereoLayout : std::uint8_t {
  kTwoDevices,
  kSideBySide,         // one device, the left image on the left: twice as wide as an eye
  kSideBySideSwapped,  // the right image on the left
  kTopBottom,          // the left image above: twice as high as an eye
  kInterleaved,        // Y8I: the two images pixel by pixel; as wide as an eye
};

// "two", "sbs", "sbs-swap", "tb", "y8i"
[[nodiscard]] const char* to_string(StereoLayout layout);

struct LiveOptions {
  // A camera, by a name that open_v4l2() or open_libcamera() takes.
  std::string left;
  std::string right;  // kTwoDevices only; otherwise empty
  StereoLayout layout = StereoLayout::kTwoDevices;

  int width_px = 0, height_px = 0;    // of one eye; 0: the calibration's, and without one what the device is set to
  double rate_hz = 0;                 // 0: what the device is set to
  std::string format;                 // "GREY", "YUYV", "MJPG", ...; empty: the first that both devices have
  std::filesystem::path calibration;  // as RecordingOptions; empty: rig() stays empty

  std::int64_t pair_tolerance_ns = 0;  // 0: half a period, at most 8 ms
  int buffers = 4;                     // each device, 3 .. 32

  int warm_up_frames = 15;    // pairs that are left out while exposure and white balance settle, 0 .. 1000
  bool lock_exposure = true;  // then exposure, gain and white balance are fixed, and the left one's copied to the right

  // How long a camera that is gone is looked for, from the moment of its loss; 0: not at all.
  std::int64_t reconnect_timeout_ns = 30'000'000'000;
};

enum class LiveState : std::uint8_t {
  kStopped,
  kWarmingUp,
  kStreaming,
  kReconnecting,  // a camera is gone; acquire() looks for it
  kLost,          // it did not come back in time: stop() and start() try again
};

[[nodiscard]] const char* to_string(LiveState state);  // "streaming", "reconnecting", ...

// What the time of an image means.
enum class LiveClock : std::uint8_t {
  kUnknown,          // nothing arrived yet
  kStartOfExposure,  // CLOCK_MONOTONIC, as uvcvideo declares
  kEndOfFrame,       // CLOCK_MONOTONIC, end of the transfer
  kArrival,          // the driver gave none: CLOCK_MONOTONIC when the buffer was taken, later by an unknown time
};

[[nodiscard]] const char* to_string(LiveClock clock);  // "start of exposure", ...

// Of one device, since the last start().
struct LiveDeviceStatistics {
  std::string node;  // now; another one, perhaps, after a reconnection. libcamera: the camera's id
  std::string id;    // by which it is found again; empty: by its node alone
  std::string card, bus;
  std::string format;               // negotiated
  int width_px = 0, height_px = 0;  // of the buffer, negotiated
  double rate_hz = 0;               // negotiated; 0: the driver does not say
  LiveClock clock = LiveClock::kUnknown;
  std::uint64_t arrived = 0;         // good images
  std::uint64_t dropped = 0;         // by the driver, from gaps in its numbers
  std::uint64_t damaged = 0;         // flagged by the driver, too short, undecodable, or not later than the one before
  std::uint64_t unpaired = 0;        // without a partner within the tolerance
  std::vector<std::string> locked;   // controls that were fixed: "exposure_time_absolute 157"
  std::vector<std::string> notices;  // "it has no gain control: ..."; no error
};

struct LiveStatistics {
  LiveState state = LiveState::kStopped;
  LiveDeviceStatistics left, right;  // one device for both: right is empty
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

// configure(): cameras are opened and the format negotiated; kNotFound (no such camera), kUnavailable (busy,
// forbidden), kUnsupported (a format, a size or a layout that the camera or this build has not; the sentence says what
// it has), kInvalidArgument (options out of range), and those of the calibration. acquire(): kTimeout with what to look
// at; while a camera is gone kTimeout as well, and kNotFound once reconnect_timeout_ns is over. Memory is bounded by
// the buffers and two images. One thread at a time.
class LiveSource : public StereoSource {
 public:
  [[nodiscard]] virtual LiveStatistics statistics() const = 0;
};

}  // namespace accrete::hal
