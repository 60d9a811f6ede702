// Records what a stereo source delivers as a EuRoC folder, which this and other programs read. Whoever captures never
// waits for the disk, and whatever ends the recording, everything up to the last complete frame can be replayed;
// docs/reference/recordings.md has the layout and the order of writing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "accrete/hal/motion_source.h"
#include "accrete/hal/stereo_source.h"

namespace accrete::hal {

struct RecorderSettings {
  // Pixels that wait for the disk at most, as captured; room for 3 pairs at least.
  std::size_t buffer_bytes = std::size_t{128} << 20;
  // When they are used up: false, the frame is dropped and counted (a camera does not wait); true, record() waits (a
  // file does).
  bool wait_when_full = false;
  // How often what was written is forced to the disk, so that a power failure costs no more than that. Zero: after
  // every frame. A killed program costs nothing in any case.
  std::int64_t sync_period_ns = 1'000'000'000;
  // A frame waits at most this long, from record() on, for its pose. Nothing but the writing waits meanwhile.
  std::int64_t pose_wait_ns = 100'000'000;
};

struct RecorderCounters {
  std::uint64_t offered = 0;                   // calls of record()
  std::uint64_t written = 0;                   // complete in the recording
  std::uint64_t dropped = 0;                   // the disk was too slow
  std::uint64_t refused = 0;                   // a time not after the frame before, or an image that is none
  std::uint64_t without_pose = 0;              // of those written
  std::uint64_t bytes = 0;                     // of images
  std::size_t most_waiting = 0, capacity = 0;  // pairs in the buffer
};

class Recorder {
 public:
  virtual ~Recorder() = default;
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // Copies the frame and returns. kOk: taken; kCapacityExceeded: dropped, the disk is too slow; kInvalidArgument:
  // refused; kUnavailable: nothing can be written any more, finish() says why.
  virtual Status record(const StereoFrame& frame) = 0;
  // Writes what waits, forces it to the disk and ends; the destructor does the same. Status: kUnavailable (the disk is
  // full or gone; the sentence says which file, and how many frames can be replayed). A second call repeats the first.
  virtual Outcome finish() = 0;
  // From any thread.
  [[nodiscard]] virtual RecorderCounters counters() const = 0;

 protected:
  Recorder() = default;
};

// Makes `folder`/mav0 and starts the thread that writes. `rig` without focal lengths: no calibration is written, and
// whoever replays has to give one. `motion` (or null: no poses) is asked from that thread and must live as long.
// Status: kUnavailable (there is a recording already, or the folder cannot be written), kUnsupported (no PNG in this
// build), kInvalidArgument (a setting out of range).
Outcome make_recorder(const std::filesystem::path& folder, const StereoRig& rig, MotionSource* motion,
                      const RecorderSettings& settings, std::unique_ptr<Recorder>& recorder);

}  // namespace accrete::hal
