#include "replay/replay_source.h"

#include <new>

#include "calibration/find.h"
#include "text/sentence.h"

namespace accrete::hal {
namespace {

Outcome unlike(const std::filesystem::path& path, int width, int height, const Camera& camera) {
  return {Status::kInvalidArgument, path.string() + " has " + size_text(width, height) +
                                        " pixels, the calibration is for " +
                                        size_text(camera.width_px, camera.height_px) +
                                        ": use the calibration of these images, or scale them to its size"};
}

bool fits(const ImageHeader& header, const Camera& camera) {
  return header.width_px == camera.width_px && header.height_px == camera.height_px;
}

void take_sizes(const ImageHeader& left, const ImageHeader& right, StereoRig& rig) {
  rig.left.width_px = left.width_px;
  rig.left.height_px = left.height_px;
  rig.right.width_px = right.width_px;
  rig.right.height_px = right.height_px;
}

}  // namespace

ReplaySource::ReplaySource(std::filesystem::path path, RecordingOptions options)
    : path_(std::move(path)), options_(std::move(options)) {}

Outcome ReplaySource::list_frames() {
  if (layout_.kind != RecordingKind::kEuroc) {
    if (Outcome o = list_folders(layout_, list_); !o.ok()) return o;
    if (Outcome o = assign_times(layout_, options_.rate_hz, list_, info_); !o.ok()) return o;
  } else {
    if (Outcome o = list_euroc(layout_, list_, info_.warnings); !o.ok()) return o;
    info_.times_source = (layout_.left / "data.csv").string() + ", nanoseconds";
    if (options_.rate_hz)
      if (Outcome o = assign_times(layout_, options_.rate_hz, list_, info_); !o.ok()) return o;
  }
  info_.frames = list_.frames.size();
  info_.left_only = list_.left_only;
  info_.right_only = list_.right_only;
  info_.first = list_.frames.front().t_left;
  info_.last = list_.frames.back().t_left;
  counters_.unpaired = list_.left_only + list_.right_only;
  if (counters_.unpaired > 0)
    info_.warnings.push_back(count(list_.left_only, "left image") + " and " + count(list_.right_only, "right image") +
                             " have no partner and are left out");
  return {};
}

// One frame that fits is enough, so that a single odd image does not stop a recording; after 16 that do not, the
// calibration is for another size.
Outcome ReplaySource::check_sizes() {
  constexpr int kMaxTries = 16;
  StereoRig& rig = calibration_.rig;
  Outcome failure;
  int tries = 0;
  for (const FrameFiles& frame : list_.frames) {
    if (tries == kMaxTries) break;
    ImageHeader left, right;
    Outcome o = left_.reader.open(frame.left, left);
    if (o.ok()) o = right_.reader.open(frame.right, right);
    if (o.ok()) {
      ++tries;
      if (rig.left.width_px == 0) take_sizes(left, right, rig);
      if (!options_.require_sane_rig && !(fits(left, rig.left) && fits(right, rig.right))) {
        info_.warnings.push_back(unlike(frame.left, left.width_px, left.height_px, rig.left).message);
        take_sizes(left, right, rig);
      }
      if (!fits(left, rig.left)) o = unlike(frame.left, left.width_px, left.height_px, rig.left);
      if (o.ok() && !fits(right, rig.right)) o = unlike(frame.right, right.width_px, right.height_px, rig.right);
    }
    if (o.ok()) {
      info_.width_px = left.width_px;
      info_.height_px = left.height_px;
      info_.image_channels = left.channels;
      info_.image_bits = left.bits;
      info_.image_format = to_string(left.format);
      return {};
    }
    // The first sentence, but rather one about a size than one about a damaged file.
    if (failure.ok() || (o.status == Status::kInvalidArgument && failure.status != o.status)) failure = std::move(o);
  }
  return failure;
}

Outcome ReplaySource::do_configure() {
  info_ = {};
  info_.root = path_;
  counters_ = {};
  if (Outcome o = detect(path_, options_.kind, layout_, info_.guesses); !o.ok()) return o;
  info_.kind = layout_.kind;
  info_.root = layout_.root;
  if (Outcome o = list_frames(); !o.ok()) return o;
  if (Outcome o = find_calibration(layout_, options_.calibration, calibration_); !o.ok()) {
    if (options_.require_sane_rig || !calibration_.complete) return o;
    info_.warnings.push_back(std::move(o.message));
  }
  info_.calibrated_width_px = calibration_.rig.left.width_px;
  info_.calibrated_height_px = calibration_.rig.left.height_px;
  info_.calibration_source = calibration_.source;
  info_.calibration_convention = calibration_.convention;
  info_.guesses.insert(info_.guesses.end(), calibration_.guesses.begin(), calibration_.guesses.end());
  if (Outcome o = check_sizes(); !o.ok()) return o;
  rig_ = calibration_.rig;
  return {};
}

Outcome ReplaySource::do_start() {
  next_ = 0;
  if (!second_thread_) second_thread_.emplace();
  return {};
}

void ReplaySource::read(const std::filesystem::path& path, const Camera& camera, Eye& eye) {
  ImageHeader header;
  try {
    eye.outcome = eye.reader.open(path, header);
    if (!eye.outcome.ok()) return;
    eye.outcome =
        fits(header, camera) ? eye.reader.decode(eye.image) : unlike(path, header.width_px, header.height_px, camera);
  } catch (const std::bad_alloc&) {
    eye.outcome = {Status::kDataLoss, path.string() + ": no memory for an image of this size: close other programs"};
  }
}

Outcome ReplaySource::do_acquire(std::int64_t /*timeout_ns*/, StereoFrame& frame) {
  if (next_ == list_.frames.size())
    return {Status::kEndOfStream, path_.string() + " is finished after " + count(list_.frames.size(), "frame")};
  const FrameFiles& files = list_.frames[next_];
  const std::size_t sequence = next_++;
  struct Work {
    ReplaySource& source;
    const FrameFiles& files;
  } work{*this, files};
  second_thread_->run_both(
      [](void* argument, int which) {
        const auto& [source, frame_files] = *static_cast<Work*>(argument);
        if (which == 0)
          read(frame_files.left, source.rig_.left, source.left_);
        else
          read(frame_files.right, source.rig_.right, source.right_);
      },
      &work);
  const Outcome& failure = left_.outcome.ok() ? right_.outcome : left_.outcome;
  if (!failure.ok())
    return {Status::kDataLoss, "frame " + std::to_string(sequence) + " is left out: " + failure.message};
  frame.left = left_.image.view();
  frame.right = right_.image.view();
  frame.t_left = files.t_left;
  frame.t_right = files.t_right;
  frame.sequence = sequence;
  return {};
}

}  // namespace accrete::hal
