#include "cli/run/configuration.h"

#include "cli/run/params_table.h"
#include "cli/text/json_text.h"
#include "cli/text/number.h"
#include "cli/write/snapshot.h"

namespace accrete::cli {
namespace {

using nlohmann::ordered_json;

// A float as the shortest decimal that names it, not as the double nearest to it: 0.4 and not 0.4000000059604645.
double decimal(float value) {
  double out = 0;
  (void)parse_number(number_text(value), out);
  return out;
}

ordered_json tunables(const Params& params) {
  ordered_json out;
  for_each_param(params, [&out](const char* stage, const char* name, auto value) {
    if constexpr (std::is_floating_point_v<decltype(value)>)
      out[stage][name] = decimal(value);
    else
      out[stage][name] = value;
  });
  ordered_json boxes = ordered_json::array();
  for (std::size_t i = 0; i < static_cast<std::size_t>(params.excluded_count); ++i) {
    ordered_json box = ordered_json::array();
    for (const float v : params.excluded[i].min_m) box.push_back(decimal(v));
    for (const float v : params.excluded[i].max_m) box.push_back(decimal(v));
    boxes.push_back(box);
  }
  out["excluded_boxes_m"] = boxes;
  return out;
}

template <class T>
ordered_json optional_json(const std::optional<T>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json input_settings(const RunOptions& o, const Input& input) {
  ordered_json out;
  out["recording"] = o.recording;
  out["kind"] = input.kind;
  if (input.cameras) {
    out["layout"] = hal::to_string(o.cameras.layout);
    for (const auto& [label, text] : input.cameras->lines)
      out[label.starts_with("right") ? "right_device" : "left_device"] = text;
    out["warm_up_frames"] = o.cameras.warm_up_frames;
    out["reconnect_timeout_ns"] = o.cameras.reconnect_timeout_ns;
  }
  if (input.info) {
    const hal::RecordingInfo& info = *input.info;
    out["calibration"] = input.cameras ? o.cameras.calibration.string() : info.calibration_source;
    if (!input.cameras) out["times"] = info.times_source;
    out["poses"] = info.poses_source;
    out["poses_convention"] = info.poses_convention;
    out["pose_sigma_m"] = optional_json(o.input.pose_sigma_m);
    out["pose_sigma_rad"] = optional_json(o.input.pose_sigma_rad);
    out["max_pose_gap_ns"] = o.input.max_pose_gap_ns;
  } else {
    out["scene_frames"] = o.scene.frames;
    out["scene_seed"] = o.scene.seed;
    out["scene_noise_levels"] = o.scene.noise_levels;
    out["scene_pose_noise_m"] = o.scene.pose_noise_m;
    out["scene_pose_noise_rad"] = o.scene.pose_noise_rad;
  }
  out["motion"] = input.mode == MotionMode::kObjectMoves ? "object" : "camera";
  out["first_frame"] = o.frames.first;
  out["last_frame"] = o.frames.last == FrameRange{}.last ? ordered_json(nullptr) : ordered_json(o.frames.last);
  return out;
}

std::string scalar(const ordered_json& value) {
  if (value.is_number_float()) return number_text(value.get<double>());
  return json_line(value);  // JSON's strings, numbers, true, false and null are YAML's
}

std::string flow(const ordered_json& value) {
  if (!value.is_array()) return scalar(value);
  std::string out = "[";
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (i > 0) out += ", ";
    out += flow(value[i]);
  }
  out += ']';
  return out;
}

void append_yaml(std::string& out, const ordered_json& tree, std::size_t level) {
  for (const auto& [key, value] : tree.items()) {
    out.append(2 * level, ' ');
    out += key;
    out += ':';
    if (value.is_object()) {
      out += value.empty() ? " {}\n" : "\n";
      append_yaml(out, value, level + 1);
    } else {
      out += ' ';
      out += flow(value);
      out += '\n';
    }
  }
}

}  // namespace

ordered_json configuration(const RunOptions& options, const Input& input, const Engine& engine) {
  ordered_json out;
  out["input"] = input_settings(options, input);
  out["params"] = tunables(options.params);
  out["capacity"] = to_string(engine.capacity());
  out["output"] = {{"full_covariance", options.full_covariance},
                   {"overlay_every", options.overlay_every},
                   {"min_existence", decimal(options.min_existence)}};
  return out;
}

std::string to_yaml(const ordered_json& tree) {
  std::string out;
  append_yaml(out, tree, 0);
  return out;
}

}  // namespace accrete::cli
