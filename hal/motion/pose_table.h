// Pose files as they stand: one pose a line, told apart by their columns. What the poses mean is decided elsewhere.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "accrete/geometry.h"
#include "accrete/hal/stereo_source.h"
#include "accrete/motion.h"

namespace accrete::hal {

enum class PoseFormat : std::uint8_t {
  kTum,    // t tx ty tz qx qy qz qw [21 of a covariance]: seconds, metres, w last
  kKitti,  // r11 r12 r13 tx ... tz: a 3 x 4 matrix row after row; no time, one line a frame
  kEuroc,  // t, px, py, pz, qw, qx, qy, qz [, 9 more, or 21 of a covariance]: integer nanoseconds, w first
};

struct StampedPose {
  Timestamp t;  // kKitti: zero
  Quaternion rotation;
  Vec3 translation{};
  std::size_t line = 0;
  std::shared_ptr<const PoseCovariance> covariance = nullptr;  // null: none was stated; few files have any
};

struct PoseTable {
  PoseFormat format = PoseFormat::kTum;
  std::filesystem::path source;
  std::vector<StampedPose> poses;  // kTum, kEuroc: times strictly increasing
  std::vector<std::string> notices;
};

// At 1 kHz this is 17 minutes, at 200 Hz one and a half hours.
inline constexpr std::size_t kMaxPoses = 1'000'000;

// Rows that are out of order are sorted, rows that are repeated word by word dropped, both with a notice. Status: those
// of read_text; kUnsupported (columns of no known format), kDataLoss (a row with another number of columns, no row at
// all), kInvalidArgument (a value that is not finite, a rotation that is none, one time with two poses),
// kCapacityExceeded (more than kMaxPoses).
Outcome read_poses(const std::filesystem::path& path, PoseTable& table);

}  // namespace accrete::hal
