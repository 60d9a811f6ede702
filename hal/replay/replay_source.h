// Frames from files.
#pragma once

#include <optional>

#include "accrete/hal/recording.h"
#include "accrete/hal/second_thread.h"
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
  struct Eye {
    ImageReader reader;
    ImageBuffer image;
    Outcome outcome;  // of the latest read()
  };
  static void read(const std::filesystem::path& path, const Camera& camera, Eye& eye);

  std::filesystem::path path_;
  RecordingOptions options_;
  RecordingInfo info_;
  Layout layout_;
  FrameList list_;
  Calibration calibration_;
  Eye left_, right_;
  std::optional<SecondThread> second_thread_;  // decodes the right images, from start() on
  std::size_t next_ = 0;
};

}  // namespace accrete::hal
