// The result of an evaluation for people.
#include <fmt/format.h>

#include "accrete/step_report.h"
#include "cli/evaluate/evaluation.h"

namespace accrete::cli {
namespace {

using nlohmann::ordered_json;

std::string figure(const ordered_json& value, int digits) {
  return value.is_number() ? fmt::format("{:.{}f}", value.get<double>(), digits) : "-";
}
std::string percent(const ordered_json& value, int digits = 2) {
  return value.is_number() ? fmt::format("{:.{}f} %", 100 * value.get<double>(), digits) : "-";
}
std::string count(const ordered_json& value) { return std::to_string(value.get<std::size_t>()); }

Table run_table(const ordered_json& r) {
  Table table{"Run", {}, {}, ""};
  const ordered_json& f = r["frames"];
  table.rows.push_back(
      {"recording", fmt::format("{} ({})", r["recording"].get<std::string>(), r["kind"].get<std::string>())});
  table.rows.push_back({"frames", fmt::format("{} used, {} could not be used, {} kept aside", count(f["used"]),
                                              count(f["lost"]), count(f["held_out"]))});
  const ordered_json& p = r["primitives"];
  table.rows.push_back(
      {"primitives", fmt::format("{}, of them {} confirmed and {} preserved; {} are probable enough to count",
                                 count(p["all"]), count(p["confirmed"]), count(p["preserved"]), count(p["used"]))});
  if (r.contains("bounding_box")) {
    const ordered_json& b = r["bounding_box"];
    table.rows.push_back({"outside the bounding box",
                          fmt::format("{} of {} ({}), by more than {:g} mm {} ({})", count(b["outside"]), count(b["n"]),
                                      percent(b["outside_rate"]), 1e3 * b["margin_m"].get<double>(),
                                      count(b["outside_margin"]), percent(b["outside_margin_rate"]))});
  }
  if (r.contains("background_at_birth"))
    table.rows.push_back(
        {"born on a background edge",
         fmt::format("{} of {} ({})", count(r["background_at_birth"]["background"]),
                     count(r["background_at_birth"]["n"]), percent(r["background_at_birth"]["background_rate"]))});
  return table;
}

Table score_table_of(const ordered_json& s) {
  Table table{"Against the truth", {}, {}, ""};
  for (const TableRow& row : score_table(s)) table.rows.push_back({row.label, row.value});
  return table;
}

Table birth_table(const ordered_json& b) {
  Table table{"What accumulation brings",
              {"median over the primitives that are confirmed and correct at the end", "at birth", "at the end"},
              {},
              ""};
  if (b["n"] == 0) {
    table.note = "None of the confirmed primitives is correct.";
    return table;
  }
  table.rows.push_back({"perpendicular distance to their true edge (mm)", figure(b["median_at_birth_mm"], 3),
                        figure(b["median_at_end_mm"], 3)});
  table.rows.push_back({"angle to it (deg)", figure(b["tangent_at_birth_deg"], 2), figure(b["tangent_at_end_deg"], 2)});
  table.note = fmt::format("Distance at birth / at the end: {} (n {}).", figure(b["ratio"], 2), count(b["n"]));
  return table;
}

Table curve_table(const ordered_json& curve) {
  Table table{"Accuracy against the number of frames",
              {"frames", "used", "median mm", "95 % mm", "tangent deg", "precision", "completeness", "NEES",
               "phase rad", "colour"},
              {},
              ""};
  for (const ordered_json& c : curve)
    table.rows.push_back({count(c["frames"]), count(c["confirmed"]), figure(c["median_mm"], 3), figure(c["p95_mm"], 3),
                          figure(c["tangent_deg"], 2), percent(c["precision"], 1), percent(c["completeness"], 1),
                          figure(c["nees"], 2), figure(c["phase_rad"], 3), figure(c["colour"], 3)});
  return table;
}

Table hold_out_table(const ordered_json& h) {
  Table table{
      fmt::format("Images that the model has never seen (every {}th, {} more not used because they share a photograph)",
                  count(h["every"]), count(h["shared"])),
      {"frame", "predicted visible", "found", "share", "2D-primitives on the object", "explained", "share"},
      {},
      "Found: a 2D-primitive within 1.5 px across, 6 px along and 20 degrees."};
  const auto row = [](const std::string& label, const ordered_json& f) -> std::vector<std::string> {
    return {label,
            count(f["predicted_visible"]),
            count(f["found"]),
            percent(f["found_rate"], 1),
            count(f["on_object"]),
            count(f["explained"]),
            percent(f["explained_rate"], 1)};
  };
  for (const ordered_json& f : h["per_frame"]) table.rows.push_back(row(count(f["frame"]), f));
  table.rows.push_back(row("all", h));
  return table;
}

Table timing_table(const ordered_json& r) {
  const ordered_json &t = r["timing_ms"], &versions = r["versions"];
  Table table{"Time of a step (ms)", {"stage", "median", "mean", "95 %", "max"}, {}, ""};
  table.note = fmt::format("{}, {}, {}, {}.", r["threads"] == 1 ? "One thread" : "Each image in a thread of its own",
                           versions["processor"].get<std::string>(), versions["instruction_set"].get<std::string>(),
                           versions["compiler"].get<std::string>());
  const auto row = [&](const std::string& stage) {
    const ordered_json& s = t[stage];
    table.rows.push_back({stage, figure(s["p50"], 3), figure(s["mean"], 3), figure(s["p95"], 3), figure(s["max"], 3)});
  };
  for (int i = 0; i < kStageCount; ++i) row(to_string(static_cast<Stage>(i)));
  row("step");
  return table;
}

}  // namespace

std::vector<Table> evaluation_tables(const ordered_json& r) {
  std::vector<Table> tables;
  if (r.contains("frames")) tables.push_back(run_table(r));
  if (r.contains("score")) tables.push_back(score_table_of(r["score"]));
  if (r.contains("birth")) tables.push_back(birth_table(r["birth"]));
  if (r.contains("curve") && !r["curve"].empty()) tables.push_back(curve_table(r["curve"]));
  if (r.contains("hold_out")) tables.push_back(hold_out_table(r["hold_out"]));
  if (r.contains("timing_ms")) tables.push_back(timing_table(r));
  return tables;
}

}  // namespace accrete::cli
