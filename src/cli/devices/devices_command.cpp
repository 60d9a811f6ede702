#include "cli/devices/devices_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/text/json_text.h"
#include "cli/text/print.h"

namespace accrete::cli {
namespace {

using hal::StereoLayout;
using nlohmann::ordered_json;

std::string size_text(const hal::V4l2Size& size) {
  std::string text = fmt::format("{}x{}", size.width_px, size.height_px);
  if (size.max_width_px != size.width_px || size.max_height_px != size.height_px)
    text += fmt::format("..{}x{}", size.max_width_px, size.max_height_px);
  if (!size.rates_hz.empty()) text += fmt::format(" at {:.4g} Hz", size.rates_hz.front());
  return text;
}

// What is to be typed: the stable name where there is one.
std::string how_to_use(const hal::V4l2Device& device) {
  const std::string name = device.id.empty() ? device.node : device.id;
  if (device.likely_layout == StereoLayout::kTwoDevices) return fmt::format("v4l2:{},...", name);
  return fmt::format("v4l2:{} --layout {}", name, hal::to_string(device.likely_layout));
}

void add_v4l2(const hal::V4l2Device& device, std::string& out) {
  if (!device.problem.empty()) {
    out += fmt::format("{}  cannot be asked: {}\n", device.node, device.problem);
    return;
  }
  out += fmt::format("{}  {} ({}, {})\n", device.node, device.card, device.driver, device.bus);
  out += fmt::format("  use    {}\n", how_to_use(device));
  for (const hal::V4l2Format& format : device.formats) {
    out += fmt::format("  {:6}", format.fourcc);
    for (std::size_t i = 0; i < format.sizes.size(); ++i) out += (i > 0 ? ", " : " ") + size_text(format.sizes[i]);
    out += format.understood ? "\n" : "  (not understood)\n";
  }
}

void add_libcamera(const hal::LibcameraCamera& camera, std::string& out) {
  out += fmt::format("{}  {} (libcamera)\n", camera.id, camera.model);
  if (!camera.problem.empty()) {
    out += fmt::format("  cannot be asked: {}\n", camera.problem);
    return;
  }
  out += fmt::format("  use    libcamera:{},...\n", camera.id);
  for (const hal::LibcameraFormat& format : camera.formats)
    out += fmt::format("  {:6} {}{}\n", format.name, fmt::join(format.sizes, ", "),
                       format.understood ? "" : "  (not understood)");
  for (const std::string& control : camera.controls) out += fmt::format("  control {}\n", control);
}

ordered_json v4l2_json(const hal::V4l2Device& device) {
  ordered_json formats = ordered_json::array();
  for (const hal::V4l2Format& format : device.formats) {
    ordered_json sizes = ordered_json::array();
    for (const hal::V4l2Size& size : format.sizes)
      sizes.push_back({{"width_px", size.width_px},
                       {"height_px", size.height_px},
                       {"max_width_px", size.max_width_px},
                       {"max_height_px", size.max_height_px},
                       {"rates_hz", size.rates_hz}});
    formats.push_back({{"fourcc", format.fourcc}, {"understood", format.understood}, {"sizes", sizes}});
  }
  return {{"kind", "v4l2"},
          {"node", device.node},
          {"id", device.id},
          {"card", device.card},
          {"driver", device.driver},
          {"bus", device.bus},
          {"likely_layout", hal::to_string(device.likely_layout)},
          {"problem", device.problem},
          {"formats", formats}};
}

ordered_json libcamera_json(const hal::LibcameraCamera& camera) {
  ordered_json formats = ordered_json::array();
  for (const hal::LibcameraFormat& format : camera.formats)
    formats.push_back({{"name", format.name}, {"understood", format.understood}, {"sizes", format.sizes}});
  return {{"kind", "libcamera"},       {"id", camera.id},    {"model", camera.model},
          {"problem", camera.problem}, {"formats", formats}, {"controls", camera.controls}};
}

}  // namespace

std::string devices_text(const Devices& devices) {
  if (devices.v4l2.empty() && devices.libcamera.empty())
    return "no camera: none is plugged in, its driver is not loaded, or this build has neither V4L2 nor libcamera "
           "(docs/reference/cameras.md)\n";
  std::string out;
  for (const hal::V4l2Device& device : devices.v4l2) add_v4l2(device, out);
  for (const hal::LibcameraCamera& camera : devices.libcamera) add_libcamera(camera, out);
  return out;
}

std::string devices_json(const Devices& devices) {
  ordered_json list = ordered_json::array();
  for (const hal::V4l2Device& device : devices.v4l2) list.push_back(v4l2_json(device));
  for (const hal::LibcameraCamera& camera : devices.libcamera) list.push_back(libcamera_json(camera));
  return json_text({{"schema", "accrete-devices-1"}, {"libcamera", hal::libcamera_version()}, {"devices", list}});
}

ExitStatus devices_command(const DevicesOptions& options) {
  const Devices devices{hal::list_v4l2_devices(), hal::list_libcamera_cameras()};
  print("{}", options.json ? devices_json(devices) : devices_text(devices));
  return ExitStatus::kOk;
}

}  // namespace accrete::cli
