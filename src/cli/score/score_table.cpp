// The result of the scorer for people: one label and one line of figures each.
#include <fmt/format.h>

#include "cli/score/score.h"

namespace accrete::cli {
namespace {

using nlohmann::ordered_json;

std::string figure(const ordered_json& value, int digits = 3) {
  return value.is_number() ? fmt::format("{:.{}f}", value.get<double>(), digits) : "-";
}

std::string percent(const ordered_json& value, int digits = 2) {
  return value.is_number() ? fmt::format("{:.{}f} %", 100 * value.get<double>(), digits) : "-";
}

std::string spread(const ordered_json& s, const char* unit) {
  if (s["n"] == 0) return "none";
  return fmt::format("median {}, RMS {}, 95 % below {} {} (n {})", figure(s["median"]), figure(s["rms"]),
                     figure(s["p95"]), unit, s["n"].get<std::size_t>());
}

void add_nees(const ordered_json& nees, std::vector<TableRow>& rows) {
  for (const auto& [key, label] : {std::pair{"within_tol", "NEES (4 dof), within tolerance"},
                                   std::pair{"within_gate", "NEES (4 dof), within gate"}}) {
    const ordered_json& s = nees[key];
    if (!s.contains("mean")) continue;
    rows.push_back(
        {label, fmt::format("mean {} (consistent {} .. {}, bootstrap {} .. {}), median {} (3.36), above 9.49: {} "
                            "(5 %); position {}, direction {} (2 dof each); n {}",
                            figure(s["mean"], 2), figure(s["consistent_95"][0], 2), figure(s["consistent_95"][1], 2),
                            figure(s["bootstrap_95"][0], 2), figure(s["bootstrap_95"][1], 2), figure(s["median"], 2),
                            percent(s["above_95_quantile"], 1), figure(s["mean_position_2dof"], 2),
                            figure(s["mean_direction_2dof"], 2), s["n"].get<std::size_t>())});
  }
}

void add_appearance(const ordered_json& r, std::vector<TableRow>& rows) {
  if (r.contains("colour") && r["colour"]["n"] > 0) {
    const ordered_json& s = r["colour"];
    std::string text = fmt::format("{} (n {})", percent(s["side_assignment_correct"]), s["n"].get<std::size_t>());
    if (s.contains("local_y_points_right"))
      text += fmt::format("; local y to the right {}", percent(s["local_y_points_right"]));
    rows.push_back({"colour sides right", text});
    rows.push_back(
        {"colour error, left / right",
         fmt::format("RMS {} / {} raw, {} / {} after gain and offset (0..1)", figure(s["rms_left"]),
                     figure(s["rms_right"]), figure(s["rms_left_after_gain"]), figure(s["rms_right_after_gain"]))});
  }
  if (r.contains("phase") && r["phase"]["n"] > 0) {
    const ordered_json& s = r["phase"];
    std::string text = fmt::format("{} within 0.5 rad of a step, median deviation {} rad",
                                   percent(s["within_0.5rad_of_step"], 1), figure(s["median_deviation_rad"]));
    if (s.contains("positive_when_right_brighter"))
      text += fmt::format("; positive where the left side is brighter {}",
                          percent(1 - s["positive_when_right_brighter"].get<double>(), 1));
    rows.push_back({"phase", text});
  }
}

}  // namespace

std::vector<TableRow> score_table(const ordered_json& r) {
  std::vector<TableRow> rows;
  const ordered_json& c = r["counts"];
  const auto n = [&c](const char* key) { return c[key].get<std::size_t>(); };
  rows.push_back({"primitives", fmt::format("{} (tentative {}, confirmed {}, preserved {})", n("primitives"),
                                            n("tentative"), n("confirmed"), n("preserved"))});
  rows.push_back(
      {"used / judged", fmt::format("{} with existence >= {:g} / {} judged ({} outside the region, {} at extra edges)",
                                    n("confirmed_used"), r["settings"]["min_existence"].get<double>(), n("judged"),
                                    n("outside_region"), n("not_judged_extra"))});
  rows.push_back({"distance of correct ones", spread(r["distance_mm"], "mm")});
  rows.push_back({"tangent angle of correct ones", spread(r["tangent_deg"], "deg")});
  rows.push_back({fmt::format("distance within {:g} mm", r["distance_mm_gate"]["gate_mm"].get<double>()),
                  spread(r["distance_mm_gate"], "mm")});
  rows.push_back(
      {"precision", fmt::format("{}; outliers {}, wrong direction {} (tolerance {:g} mm, {:g} deg)",
                                percent(r["precision"]), percent(r["outlier_rate"]), percent(r["wrong_direction_rate"]),
                                r["settings"]["tol_mm"].get<double>(), r["settings"]["angle_deg"].get<double>())});
  std::string completeness = fmt::format("{} of {} m", percent(r["completeness"], 1), figure(r["truth_length_m"]));
  if (r.contains("completeness_by_kind") && r["completeness_by_kind"].size() < 7)
    for (const auto& [kind, value] : r["completeness_by_kind"].items())
      completeness += fmt::format("; {} {}", kind.empty() ? "unnamed" : kind, percent(value, 1));
  rows.push_back({"completeness", completeness});
  rows.push_back({"primitives per covered 10 mm", figure(r["primitives_per_covered_10mm"], 2)});
  const ordered_json& leakage = r["leakage"];
  if (leakage.contains("outside_bbox"))
    rows.push_back({"outside the bounding box", fmt::format("{} ({})", leakage["outside_bbox"].get<std::size_t>(),
                                                            percent(leakage["outside_bbox_rate"]))});
  if (leakage.contains("background"))
    rows.push_back({"on background edges", fmt::format("{} ({})", leakage["background"].get<std::size_t>(),
                                                       percent(leakage["background_rate"]))});
  if (r.contains("surface"))
    rows.push_back(
        {"on the object's faces", fmt::format("{} within tolerance; {}", percent(r["surface"]["within_tol_rate"]),
                                              spread(r["surface"]["distance_mm"], "mm"))});
  add_appearance(r, rows);
  if (r.contains("nees")) add_nees(r["nees"], rows);
  rows.push_back({"existence calibration error", fmt::format("{} (all states, n {})", figure(r["existence"]["ece"]),
                                                             r["existence"]["n"].get<std::size_t>())});
  for (const ordered_json& bin : r["existence"]["bins"])
    rows.push_back({"  existence " + bin["bin"].get<std::string>(),
                    fmt::format("n {}, mean {}, correct {}", bin["n"].get<std::size_t>(), figure(bin["mean_existence"]),
                                figure(bin["fraction_correct"]))});
  for (const ordered_json& note : r["notes"]) rows.push_back({"note", note.get<std::string>()});
  return rows;
}

}  // namespace accrete::cli
