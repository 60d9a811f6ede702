// A model as a file: the whole state of an Accumulator between two steps, with a version, a checksum, and marks of the
// layout and the limits of the library that wrote it. docs/reference/saved_model.md has its bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "accrete/limits.h"
#include "accrete/status.h"
#include "accrete/timestamp.h"

namespace accrete {

// Why a saved model is refused. All but the last are found before a byte of the state is looked at.
enum class SavedModelFault : std::uint8_t {
  kNone,
  kNoModel,       // another kind of file
  kOtherVersion,  // of the format
  kOtherLayout,   // another library, whose state has other members, or a machine with another byte order
  kOtherLimits,   // an Accumulator with other capacities
  kCutOff,        // or longer than it says
  kDamaged,       // the checksum does not fit
  kImpossible,    // checksum and lengths fit, but no run ends in such a state
};

// What is wrong and what to do, as a sentence without a full stop.
[[nodiscard]] const char* to_string(SavedModelFault fault);

// What can be said of the times of the next frame.
enum class RestoredClock : std::uint8_t {
  kGoesOn,      // the same clock as before: later than the last frame, or step() refuses it
  kStartsAnew,  // another clock. The previous images are forgotten with the old one: the first frame has no optic flow
};

struct [[nodiscard]] RestoreReport {
  // kUnavailable (not configured), kInvalidArgument (kNoModel, kImpossible), kUnsupported (kOtherVersion,
  // kOtherLayout), kCapacityExceeded (kOtherLimits), kDataLoss (kCutOff, kDamaged).
  Status status = Status::kOk;
  SavedModelFault fault = SavedModelFault::kNone;
};

// What a saved model says about itself.
struct SavedModelInfo {
  Capacities capacities;
  std::uint32_t frames = 0;                   // that were accumulated
  std::uint32_t primitives = 0;               // of any state
  std::uint32_t width_px = 0, height_px = 0;  // of the left image that it saw last; 0: none
  bool has_times = false;
  Timestamp last;  // left image of the last frame
};

// kNone, and `info` is filled in; or the first of kNoModel, kOtherVersion, kOtherLayout, kCutOff and kDamaged. It does
// not say whether the state is possible: restore() does.
[[nodiscard]] SavedModelFault read_saved_model_info(std::span<const std::byte> bytes, SavedModelInfo& info);

}  // namespace accrete
