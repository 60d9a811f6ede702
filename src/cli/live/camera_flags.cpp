#include "cli/live/camera_flags.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <string_view>

#include "cli/failure.h"
#include "cli/run/units.h"

namespace accrete::cli {
namespace {

using hal::StereoLayout;

[[noreturn]] void fail(const std::string& sentence) { throw Failure(ExitStatus::kUsage, sentence); }

constexpr StereoLayout kLayouts[] = {StereoLayout::kTwoDevices, StereoLayout::kSideBySide,
                                     StereoLayout::kSideBySideSwapped, StereoLayout::kTopBottom,
                                     StereoLayout::kInterleaved};

StereoLayout layout_of(const std::string& text) {
  for (const StereoLayout layout : kLayouts)
    if (text == hal::to_string(layout)) return layout;
  fail(fmt::format("--layout {}: give two, sbs, sbs-swap, tb or y8i", text));
}

bool parse_side(std::string_view text, int& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() && value > 0 && value <= 100'000;
}

}  // namespace

ImageSize parse_size(const std::string& flag, const std::string& text) {
  const std::string_view all = text;
  const std::size_t x = all.find('x');
  ImageSize size;
  if (x == std::string_view::npos || !parse_side(all.substr(0, x), size.width_px) ||
      !parse_side(all.substr(x + 1), size.height_px))
    fail(fmt::format("{} {}: give width and height in pixels, 640x480", flag, text));
  return size;
}

void CameraFlags::add(CLI::App& app) {
  const char* group = "Live cameras (v4l2: or libcamera:, LEFT,RIGHT or one DEVICE with --layout)";
  const auto option = [&app, group](const char* name, auto& value, const char* kind, const char* help) {
    return app.add_option(name, value, help)->option_text(kind)->group(group);
  };
  option("--layout", layout_, "LAYOUT",
         "One device delivers both images: sbs (side by side), sbs-swap,\ntb (left above right), y8i (pixel by pixel)")
      ->check(CLI::IsMember({"two", "sbs", "sbs-swap", "tb", "y8i"}));
  option("--size", size_, "WxH", "Pixels of one eye (default: the calibration's)");
  option("--format", plain_.format, "FOURCC", "YUYV, MJPG, GREY, ... (default: the best that is understood)");
  option("--pair-tolerance", tolerance_, "TIME",
         "Largest difference of the times of a pair (default half a period, 8ms)");
  option("--warm-up", plain_.warm_up_frames, "N", "Pairs left out while exposure settles (default 15)")
      ->check(CLI::Range(0, 1000));
  app.add_flag("--auto-exposure", keep_automatic_, "Leave exposure, gain and white balance to each camera")
      ->group(group);
  option("--control", controls_, "NAME=VALUE",
         "libcamera: a control of both cameras, ExposureTime=8000 (repeatable;\naccrete devices shows them)");
  option("--reconnect", reconnect_, "TIME", "How long a lost camera is looked for (default 30s)");
}

bool are_cameras(std::string_view recording) {
  return recording.starts_with(kV4l2Prefix) || recording.starts_with(kLibcameraPrefix);
}

hal::LibcameraOptions CameraFlags::options(const std::string& recording) const {
  hal::LibcameraOptions o = plain_;
  const std::string_view kind = recording.starts_with(kV4l2Prefix) ? kV4l2Prefix : kLibcameraPrefix;
  const std::string_view devices = std::string_view(recording).substr(kind.size());
  const std::size_t comma = devices.find(',');
  o.left = devices.substr(0, comma);
  if (comma != std::string_view::npos) o.right = devices.substr(comma + 1);
  if (o.left.empty() || (comma != std::string_view::npos && o.right.empty()))
    fail(
        fmt::format("{0}: name the cameras, {1}LEFT,RIGHT, or one that delivers both images, {1}DEVICE --layout sbs; "
                    "accrete devices "
                    "shows what there is",
                    recording, kind));
  o.layout = layout_.empty() ? StereoLayout::kTwoDevices : layout_of(layout_);
  if (o.right.empty() && o.layout == StereoLayout::kTwoDevices)
    fail(
        fmt::format("{}: one camera is named: name the right one, too ({}{},RIGHT), or say how it delivers both "
                    "images (--layout sbs)",
                    recording, kind, o.left));
  if (!size_.empty()) {
    const ImageSize size = parse_size("--size", size_);
    o.width_px = size.width_px;
    o.height_px = size.height_px;
  }
  if (!tolerance_.empty()) o.pair_tolerance_ns = parse_duration_ns("--pair-tolerance", tolerance_);
  if (!reconnect_.empty()) o.reconnect_timeout_ns = parse_duration_ns("--reconnect", reconnect_);
  if (!controls_.empty() && kind != kLibcameraPrefix)
    fail("--control: controls by name are libcamera's; set those of V4L2 with v4l2-ctl before the start");
  for (const std::string& control : controls_) {
    const std::size_t equals = control.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == control.size())
      fail(fmt::format("--control {}: give a name and a value, ExposureTime=8000", control));
    o.controls.push_back({control.substr(0, equals), control.substr(equals + 1)});
  }
  o.lock_exposure = !keep_automatic_;
  return o;
}

}  // namespace accrete::cli
