#include "cli/live/live_cameras.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace accrete::cli {
namespace {

std::string device_text(const hal::LiveDeviceStatistics& d) {
  std::string text = fmt::format("{} ({}), {} x {} {}", d.node, d.card, d.width_px, d.height_px, d.format);
  if (d.rate_hz > 0) text += fmt::format(" at {:.4g} Hz", d.rate_hz);
  if (!d.id.empty()) text += fmt::format("; found again as {}", d.id);
  return text;
}

void say_device(const char* eye, const hal::LiveDeviceStatistics& d, std::vector<std::string>& out) {
  if (d.node.empty()) return;
  const auto say = [&](const std::string& text) { out.push_back(fmt::format("{} camera: {}", eye, text)); };
  std::string text = fmt::format("{} images", d.arrived);
  if (d.dropped > 0) text += fmt::format(", {} lost before they came here", d.dropped);
  if (d.damaged > 0) text += fmt::format(", {} damaged", d.damaged);
  if (d.unpaired > 0) text += fmt::format(", {} without a partner", d.unpaired);
  say(fmt::format("{}; times: {}", text, hal::to_string(d.clock)));
  if (!d.locked.empty()) say(fmt::format("fixed: {}", fmt::join(d.locked, ", ")));
  for (const std::string& notice : d.notices) say(notice);
}

double milliseconds(std::int64_t ns) { return 1e-6 * static_cast<double>(ns); }

nlohmann::ordered_json device_json(const hal::LiveDeviceStatistics& d) {
  return {{"node", d.node},
          {"id", d.id},
          {"card", d.card},
          {"bus", d.bus},
          {"format", d.format},
          {"width_px", d.width_px},
          {"height_px", d.height_px},
          {"rate_hz", d.rate_hz > 0 ? nlohmann::ordered_json(d.rate_hz) : nlohmann::ordered_json()},
          {"clock", hal::to_string(d.clock)},
          {"arrived", d.arrived},
          {"dropped", d.dropped},
          {"damaged", d.damaged},
          {"unpaired", d.unpaired},
          {"locked", d.locked},
          {"notices", d.notices}};
}

}  // namespace

std::vector<std::string> sentences(const hal::LiveStatistics& s) {
  std::vector<std::string> out;
  say_device(s.right.node.empty() ? "the" : "left", s.left, out);
  say_device("right", s.right, out);
  if (!s.right.node.empty() && s.delivered > 0)
    out.push_back(fmt::format("right minus left: {:.2f} ms in the mean, {:.2f} to {:.2f} ms; {:.2f} ms are tolerated",
                              1e-6 * s.skew_mean_ns, milliseconds(s.skew_min_ns), milliseconds(s.skew_max_ns),
                              milliseconds(s.pair_tolerance_ns)));
  if (!s.loss.empty())
    out.push_back(fmt::format("a camera was lost, {} time{} it came back; last: {}", s.reconnects,
                              s.reconnects == 1 ? "" : "s", s.loss));
  return out;
}

nlohmann::ordered_json statistics_json(const hal::LiveStatistics& s) {
  nlohmann::ordered_json out;
  out["state"] = hal::to_string(s.state);
  out["left"] = device_json(s.left);
  if (!s.right.node.empty()) out["right"] = device_json(s.right);
  out["delivered"] = s.delivered;
  out["warm_up"] = s.warm_up;
  out["reconnects"] = s.reconnects;
  out["gaps"] = s.gaps;
  out["pair_tolerance_ms"] = milliseconds(s.pair_tolerance_ns);
  out["skew_ms"] = nullptr;
  if (!s.right.node.empty() && s.delivered > 0)
    out["skew_ms"] = {
        {"min", milliseconds(s.skew_min_ns)}, {"mean", 1e-6 * s.skew_mean_ns}, {"max", milliseconds(s.skew_max_ns)}};
  out["loss"] = s.loss.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(s.loss);
  return out;
}

LiveCameras watch(const hal::LiveSource& source) {
  LiveCameras live;
  const hal::LiveStatistics s = source.statistics();
  live.lines.emplace_back(s.right.node.empty() ? "device" : "left device", device_text(s.left));
  if (!s.right.node.empty()) live.lines.emplace_back("right device", device_text(s.right));
  live.reconnecting = [&source] { return source.statistics().state == hal::LiveState::kReconnecting; };
  live.statistics = [&source] { return source.statistics(); };
  return live;
}

}  // namespace accrete::cli
