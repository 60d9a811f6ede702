#include "cli/devices/devices_command.h"

#include <fmt/format.h>

#include "cli/text/json_text.h"

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

}  // namespace

std::string devices_text(const std::vector<hal::V4l2Device>& devices) {
  if (devices.empty())
    return "no camera: none is plugged in, its driver is not loaded, or this build has no V4L2 (docs/reference/"
           "cameras.md)\n";
  std::string out;
  for (const hal::V4l2Device& device : devices) {
    if (!device.problem.empty()) {
      out += fmt::format("{}  cannot be asked: {}\n", device.node, device.problem);
      continue;
    }
    out += fmt::format("{}  {} ({}, {})\n", device.node, device.card, device.driver, device.bus);
    out += fmt::format("  use    {}\n", how_to_use(device));
    for (const hal::V4l2Format& format : device.formats) {
      out += fmt::format("  {:6}", format.fourcc);
      for (std::size_t i = 0; i < format.sizes.size(); ++i) out += (i > 0 ? ", " : " ") + size_text(format.sizes[i]);
      out += format.understood ? "\n" : "  (not understood)\n";
    }
  }
  return out;
}

std::string devices_json(const std::vector<hal::V4l2Device>& devices) {
  ordered_json list = ordered_json::array();
  for (const hal::V4l2Device& device : devices) {
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
    list.push_back({{"kind", "v4l2"},
                    {"node", device.node},
                    {"id", device.id},
                    {"card", device.card},
                    {"driver", device.driver},
                    {"bus", device.bus},
                    {"likely_layout", hal::to_string(device.likely_layout)},
                    {"problem", device.problem},
                    {"formats", formats}});
  }
  return json_text({{"schema", "accrete-devices-1"}, {"devices", list}});
}

ExitStatus devices_command(const DevicesOptions& options) {
  const std::vector<hal::V4l2Device> devices = hal::list_v4l2_devices();
  fmt::print("{}", options.json ? devices_json(devices) : devices_text(devices));
  return ExitStatus::kOk;
}

}  // namespace accrete::cli
