// Writes a EuRoC folder frame by frame, in an order that leaves a recording whatever ends it:
//   both images, each whole or not at all; then the pose; then the line of the right camera; then that of the left one.
// A frame is complete with its last line, and everything that this line needs is there before it.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "accrete/hal/recorder.h"
#include "record/disk.h"

namespace accrete::hal {

class RecordingWriter {
 public:
  RecordingWriter(Disk& disk, const std::filesystem::path& folder, const StereoRig& rig, MotionSource* motion,
                  const RecorderSettings& settings);

  // Folders, calibration, heads of the lists. Status: those of make_recorder.
  Outcome begin();
  // One frame. `taken` is when it was captured: its pose is waited for from then on. Status: kUnavailable; then the
  // recording is as it was before.
  Outcome write(const StereoFrame& frame, std::chrono::steady_clock::time_point taken);
  // The frame rate into the calibration, everything to the disk.
  Outcome end();

  [[nodiscard]] std::uint64_t frames() const { return frames_; }
  [[nodiscard]] std::uint64_t without_pose() const { return without_pose_; }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 private:
  Outcome write_calibration(double rate_hz);
  Outcome write_image(const std::filesystem::path& camera, const ImageView& image, Timestamp t);
  Outcome write_pose(Timestamp t, std::chrono::steady_clock::time_point taken);

  Disk& disk_;
  std::filesystem::path mav_, left_, right_, poses_;
  StereoRig rig_;
  MotionSource* motion_;
  RecorderSettings settings_;
  std::vector<std::uint8_t> png_;
  std::optional<Motion> first_pose_;  // the others are written alike
  std::optional<Timestamp> first_, last_;
  std::chrono::steady_clock::time_point synced_ = std::chrono::steady_clock::now();
  std::uint64_t frames_ = 0, without_pose_ = 0, bytes_ = 0;
};

}  // namespace accrete::hal
