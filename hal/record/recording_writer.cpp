#include "record/recording_writer.h"

#include <algorithm>
#include <span>

#include "image/png_encoder.h"
#include "record/sensor_file.h"
#include "text/sentence.h"

namespace accrete::hal {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

RecordingWriter::RecordingWriter(Disk& disk, const fs::path& folder, const StereoRig& rig, MotionSource* motion,
                                 const RecorderSettings& settings)
    : disk_(disk),
      mav_(folder / "mav0"),
      left_(mav_ / "cam0"),
      right_(mav_ / "cam1"),
      rig_(rig),
      motion_(motion),
      settings_(settings) {}

Outcome RecordingWriter::begin() {
  std::error_code error;
  if (fs::exists(mav_, error))
    return {Status::kUnavailable, mav_.string() + " is there already: record into another folder, or remove it first"};
  for (const fs::path& folder : {left_ / "data", right_ / "data"})
    if (Outcome o = disk_.make_folder(folder); !o.ok()) return o;
  if (Outcome o = write_calibration(0); !o.ok()) return o;
  for (const fs::path& camera : {right_, left_})
    if (Outcome o = disk_.append(camera / "data.csv", "#timestamp [ns],filename\n"); !o.ok()) return o;
  return {};
}

Outcome RecordingWriter::write_calibration(double rate_hz) {
  if (validate(rig_) != Status::kOk) return {};  // uncalibrated cameras: whoever replays gives a calibration
  const Transform<Left, Right> T_l_r = rig_.T_r_l.inverse();
  const std::string left = camera_yaml(rig_.left, {}, {}, rate_hz);
  const std::string right = camera_yaml(rig_.right, T_l_r.rotation, T_l_r.translation, rate_hz);
  if (Outcome o = disk_.write_whole(left_ / "sensor.yaml", bytes_of(left)); !o.ok()) return o;
  return disk_.write_whole(right_ / "sensor.yaml", bytes_of(right));
}

Outcome RecordingWriter::write_image(const fs::path& camera, const ImageView& image, Timestamp t) {
  const fs::path file = camera / "data" / (std::to_string(t.ns) + ".png");
  std::string reason;
  if (!encode_png(image, png_, reason)) return {Status::kUnavailable, file.string() + ": " + reason};
  bytes_ += png_.size();
  return disk_.write_whole(file, png_);
}

Outcome RecordingWriter::write_pose(Timestamp t, Clock::time_point taken) {
  if (motion_ == nullptr) return {};
  const std::int64_t waited_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - taken).count();
  Motion motion;
  if (!motion_->at_within(std::max<std::int64_t>(0, settings_.pose_wait_ns - waited_ns), t, motion).ok()) {
    ++without_pose_;  // the images are kept all the same
    return {};
  }
  std::string rows;
  if (!first_pose_) {
    poses_ = mav_ / (motion.mode == MotionMode::kObjectMoves ? "object0" : "mocap0");
    if (Outcome o = disk_.make_folder(poses_); !o.ok()) return o;
    if (Outcome o = disk_.write_whole(poses_ / "sensor.yaml", bytes_of(poses_yaml(motion))); !o.ok()) return o;
    rows = pose_header(motion);
    first_pose_ = motion;
  }
  motion.covariance_is_default = first_pose_->covariance_is_default;  // every row has the same columns
  return disk_.append(poses_ / "data.csv", rows + pose_row(t, motion));
}

Outcome RecordingWriter::write(const StereoFrame& frame, Clock::time_point taken) {
  if (Outcome o = write_image(left_, frame.left, frame.t_left); !o.ok()) return o;
  if (Outcome o = write_image(right_, frame.right, frame.t_right); !o.ok()) return o;
  if (settings_.sync_period_ns == 0)  // no line without its images, even when the power fails
    if (Outcome o = disk_.sync(mav_); !o.ok()) return o;
  if (Outcome o = write_pose(frame.t_left, taken); !o.ok()) return o;
  const auto line = [](Timestamp t) { return std::to_string(t.ns) + "," + std::to_string(t.ns) + ".png\n"; };
  if (Outcome o = disk_.append(right_ / "data.csv", line(frame.t_right)); !o.ok()) return o;
  if (Outcome o = disk_.append(left_ / "data.csv", line(frame.t_left)); !o.ok()) return o;
  ++frames_;
  if (!first_) first_ = frame.t_left;
  last_ = frame.t_left;
  if (settings_.sync_period_ns > 0 && Clock::now() - synced_ > std::chrono::nanoseconds(settings_.sync_period_ns)) {
    if (Outcome o = disk_.sync(mav_); !o.ok()) return o;
    synced_ = Clock::now();
  }
  return {};
}

Outcome RecordingWriter::end() {
  if (frames_ > 1 && *last_ - *first_ > 0)
    if (Outcome o = write_calibration(static_cast<double>(frames_ - 1) / to_seconds(*last_ - *first_)); !o.ok())
      return o;
  return disk_.sync(mav_);
}

}  // namespace accrete::hal
