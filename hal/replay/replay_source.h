// Frames from files.
#pragma once

#include "accrete/hal/recording.h"
#include "calibration/calibration.h"
#include "image/image_file.h"
#include "replay/frame_list.h"

namespace accrete::hal {

class ReplaySource final : public StereoSource {
 public:
  // `path` is looked at by configure(), not here.
  ReplaySource(std::filesystem::path path, RecordingOptions options);

  [[nodiscard]] std::uint64_t size() const override { return list_.frames.size(); }
  // What configure() found, also as far as it came when it failed.
  [[nodiscard]] const RecordingInfo& info() const { return info_; }
  // Preconditions of these: configured.
  [[nodiscard]] const Layout& layout() const { return layout_; }
  [[nodiscard]] const FrameList& list() const { return list_; }
  [[nodiscard]] const Calibration& calibration() const { return calibration_; }

 private:
  Outcome do_configure() override;
  Outcome do_start() override;  // from the first frame on, also after a stop
  Outcome do_acquire(std::int64_t timeout_ns, StereoFrame& frame) override;

  Outcome list_frames();
  Outcome check_sizes();
  Outcome read(const std::filesystem::path& path, const Camera& camera, ImageBuffer& image);

  std::filesystem::path path_;
  RecordingOptions options_;
  RecordingInfo info_;
  Layout layout_;
  FrameList list_;
  Calibration calibration_;
  ImageReader reader_;
  ImageBuffer left_, right_;
  std::size_t next_ = 0;
};

}  // namespace accrete::hal
