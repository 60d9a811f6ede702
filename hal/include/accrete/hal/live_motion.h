// Poses that arrive while the cameras run: lines of text on standard input, a FIFO or a UDP socket. Whatever can print
// can drive it; docs/reference/live.md has the format and what happens to lines that are late, damaged or hostile.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "accrete/hal/motion_source.h"

namespace accrete::hal {

struct LiveMotionOptions {
  MotionMode mode = MotionMode::kObjectMoves;
  std::optional<PoseError> error;  // absent: absolute where the object moves, incremental where the cameras do
  bool inverse = false;            // object: the lines are T_object_frame; camera: they are T_frame_world
  Transform<Left, Body> T_l_f;     // where the lines' frame is, seen from the left camera; identity: they are about it
  std::optional<double> sigma_m;   // of lines that state no covariance; absent: none, reported as default
  std::optional<double> sigma_rad;
  std::int64_t max_gap_ns = 50'000'000;  // longest gap between two poses that is interpolated
  std::int64_t wait_ns = 100'000'000;    // a frame waits this long for the pose after it: transport and a pose's period
  std::size_t capacity = 4096;           // poses that are held at least, the newest: 20 s at 200 Hz
};

struct LiveMotionCounters {
  // Lines.
  std::uint64_t poses = 0;        // understood and held
  std::uint64_t malformed = 0;    // not understood: other columns, no numbers, no rotation, too long, binary
  std::uint64_t backwards = 0;    // understood, but not after the line before
  std::uint64_t late = 0;         // understood, but only after a frame that lies behind them had been given up
  std::uint64_t interrupted = 0;  // the writer of the FIFO went away and another one came
  // Frames.
  std::uint64_t served = 0;   // with a pose
  std::uint64_t early = 0;    // before the oldest pose that is held
  std::uint64_t missing = 0;  // no pose came in time, or in a gap that is too long
};

class LiveMotion : public MotionSource {
 public:
  // Any thread may ask. Waits as long as wait_ns for the pose after `t`; not at all once the stream has ended, and no
  // longer than wait_ns after the last line, so that a silent stream does not slow the frames down. kNotFound: none;
  // the frame cannot be used.
  Outcome at(Timestamp t, Motion& motion) override = 0;
  Outcome at_within(std::int64_t wait_ns, Timestamp t, Motion& motion) override = 0;

  [[nodiscard]] virtual LiveMotionCounters counters() const = 0;
  // "poses from udp:127.0.0.1:5005"; for messages.
  [[nodiscard]] virtual std::string name() const = 0;
  // Of a UDP socket: the port that it got; otherwise 0.
  [[nodiscard]] virtual int port() const = 0;
};

// "-", "fifo:PATH", "udp:PORT" (of the loopback interface), "udp:HOST:PORT".
[[nodiscard]] bool is_live_motion(std::string_view where);

// Opens the stream and starts the thread that reads it; the destructor ends both. Status: kNotFound (no such FIFO or
// host), kInvalidArgument (not one of the above, an option out of range), kUnavailable (the port is taken, no
// permission).
Outcome open_live_motion(const std::string& where, const LiveMotionOptions& options,
                         std::unique_ptr<LiveMotion>& motion);

}  // namespace accrete::hal
