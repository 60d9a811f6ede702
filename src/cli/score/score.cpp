#include "cli/score/score.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "cli/score/appearance.h"
#include "cli/score/association.h"
#include "cli/score/consistency.h"
#include "cli/score/statistics.h"

namespace accrete::cli {
namespace {

using nlohmann::ordered_json;

constexpr double kDegree = std::numbers::pi / 180;

// What is known about one primitive before any figure is computed.
struct Judgement {
  Association truth;
  bool in_region = true;
  bool ignored = false;  // nearest to an extra edge
  bool used = false;     // confirmed or preserved, and probable enough
  bool correct = false;

  [[nodiscard]] bool judged() const { return used && in_region && !ignored; }
};

EdgePoint point_of(const ScoredEdge& e) { return {e.position, e.tangent}; }

std::vector<Judgement> judge(const ScoredEdges& edges, const Truth& truth, const ScoreSettings& s) {
  const double tolerance = s.tolerance_mm / 1e3, pitch = s.pitch_mm / 1e3, angle = s.angle_deg * kDegree;
  std::vector<Judgement> out;
  for (const ScoredEdge& e : edges.list) {
    Judgement j;
    j.truth = associate(point_of(e), *truth.edges, angle, pitch);
    j.in_region = !truth.region || truth.region->contains(e.position);
    if (truth.extra) {
      const double extra = associate(point_of(e), *truth.extra, angle, pitch).distance_m;
      j.ignored = extra < j.truth.distance_m && extra <= 2 * tolerance;
    }
    j.used = e.state != State::kTentative && e.existence >= s.min_existence;
    j.correct = j.truth.distance_m <= tolerance;
    out.push_back(j);
  }
  return out;
}

template <class Predicate>
std::size_t count(const std::vector<Judgement>& list, Predicate&& predicate) {
  return static_cast<std::size_t>(std::count_if(list.begin(), list.end(), predicate));
}

ordered_json share(std::size_t part, std::size_t whole) {
  return whole > 0 ? ordered_json(static_cast<double>(part) / static_cast<double>(whole)) : ordered_json(nullptr);
}

void score_accuracy(const std::vector<Judgement>& list, const ScoreSettings& s, ordered_json& out) {
  const std::size_t judged = count(list, [](const Judgement& j) { return j.judged(); });
  const double tolerance = s.tolerance_mm / 1e3;
  out["precision"] = share(count(list, [](const Judgement& j) { return j.judged() && j.correct; }), judged);
  out["outlier_rate"] =
      share(count(list, [&](const Judgement& j) { return j.judged() && j.truth.any_distance_m > tolerance; }), judged);
  out["wrong_direction_rate"] = share(
      count(list, [&](const Judgement& j) { return j.judged() && j.truth.any_distance_m <= tolerance && !j.correct; }),
      judged);
  std::vector<double> distance, angle, wide;
  for (const Judgement& j : list) {
    if (!j.judged()) continue;
    if (j.correct) distance.push_back(j.truth.distance_m);
    if (j.correct) angle.push_back(j.truth.angle / kDegree);
    if (j.truth.distance_m <= s.gate_mm / 1e3) wide.push_back(j.truth.distance_m);
  }
  out["distance_mm"] = summarize(distance, 1e3);
  out["tangent_deg"] = summarize(angle);
  out["distance_mm_gate"] = {{"gate_mm", s.gate_mm}};
  out["distance_mm_gate"].update(summarize(wide, 1e3));
}

void score_completeness(const ScoredEdges& edges, const std::vector<Judgement>& list, const Segments& truth,
                        const ScoreSettings& s, ordered_json& out) {
  std::vector<EdgePoint> points;
  for (std::size_t i = 0; i < list.size(); ++i)
    if (list[i].used) points.push_back(point_of(edges.list[i]));
  const std::vector<double> covered =
      coverage(points, truth, s.angle_deg * kDegree, s.tolerance_mm / 1e3, s.along_mm / 1e3);
  struct Length {
    double all_m = 0, found_m = 0;
  };
  Length visible;
  std::map<std::string, Length> by_kind;
  double found_m = 0;
  for (std::size_t k = 0; k < covered.size(); ++k) {
    const Segment& segment = truth.list[k];
    const double length = segment.length_m * covered[k];
    found_m += length;
    if (!segment.visible) continue;
    visible.all_m += segment.length_m, visible.found_m += length;
    by_kind[segment.kind].all_m += segment.length_m, by_kind[segment.kind].found_m += length;
  }
  out["truth_length_m"] = visible.all_m;
  out["completeness"] = visible.all_m > 0 ? ordered_json(visible.found_m / visible.all_m) : ordered_json(nullptr);
  if (truth.has_kinds) {
    out["completeness_by_kind"] = ordered_json::object();
    for (const auto& [kind, length] : by_kind) out["completeness_by_kind"][kind] = length.found_m / length.all_m;
  }
  const auto good = static_cast<double>(count(list, [](const Judgement& j) { return j.judged() && j.correct; }));
  out["primitives_per_covered_10mm"] = found_m > 0 ? ordered_json(good / (found_m / 0.01)) : ordered_json(nullptr);
}

void score_leakage(const ScoredEdges& edges, const std::vector<Judgement>& list, const Truth& truth,
                   const ScoreSettings& s, ordered_json& out) {
  const std::size_t used = count(list, [](const Judgement& j) { return j.used; });
  std::size_t outside = 0, background = 0;
  std::vector<double> surface;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!list[i].used) continue;
    const ScoredEdge& e = edges.list[i];
    if (truth.bbox && !truth.bbox->contains(e.position)) ++outside;
    if (truth.background && !list[i].correct && !list[i].ignored &&
        associate(point_of(e), *truth.background, s.angle_deg * kDegree, s.pitch_mm / 1e3).distance_m <=
            s.background_tolerance_mm / 1e3)
      ++background;
    if (!truth.faces.empty()) surface.push_back(distance_to_faces(e.position, truth.faces, s.tolerance_mm / 1e3));
  }
  ordered_json& leakage = out["leakage"] = ordered_json::object();
  if (truth.bbox) leakage["outside_bbox"] = outside, leakage["outside_bbox_rate"] = share(outside, used);
  if (truth.background) leakage["background"] = background, leakage["background_rate"] = share(background, used);
  if (truth.faces.empty()) return;
  const double tolerance = s.tolerance_mm / 1e3;
  const auto within = std::count_if(surface.begin(), surface.end(), [=](double h) { return h <= tolerance; });
  std::erase_if(surface, [=](double h) { return !(h <= 5 * tolerance); });
  out["surface"] = {{"within_tol_rate", share(static_cast<std::size_t>(within), used)},
                    {"distance_mm", summarize(surface, 1e3)}};
}

ordered_json score_nees_of(const ScoredEdges& edges, const std::vector<Judgement>& list, const Truth& truth,
                           const ScoreSettings& s, double gate_m) {
  std::vector<double> all, position, direction;
  std::size_t invalid = 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!list[i].judged() || !(list[i].truth.distance_m <= gate_m)) continue;
    const auto value = nees(edges.list[i], truth.edges->list[static_cast<std::size_t>(list[i].truth.segment)],
                            s.truth_sigma_mm / 1e3, s.truth_sigma_deg * kDegree);
    if (!value) {
      ++invalid;
      continue;
    }
    all.push_back(value->all), position.push_back(value->position), direction.push_back(value->direction);
  }
  if (all.empty() && invalid == 0) return {{"n", 0}};
  ordered_json out{{"n", all.size()}, {"invalid_covariance", invalid}};
  if (all.empty()) return out;
  const auto n = static_cast<double>(all.size());
  out["mean"] = mean(all);
  out["median"] = median(all);
  out["expected_mean"] = 4.0;
  out["expected_median"] = 3.357;  // of the chi-square distribution with 4 degrees of freedom
  out["consistent_95"] = {chi2_quantile(0.025, 4 * n) / n, chi2_quantile(0.975, 4 * n) / n};
  out["bootstrap_95"] = bootstrap_mean_95(all);
  out["above_95_quantile"] =
      static_cast<double>(std::count_if(all.begin(), all.end(), [](double v) { return v > 9.488; })) / n;
  out["mean_position_2dof"] = mean(position);
  out["mean_direction_2dof"] = mean(direction);
  return out;
}

void score_nees(const ScoredEdges& edges, const std::vector<Judgement>& list, const Truth& truth,
                const ScoreSettings& s, ordered_json& out, std::vector<std::string>& notes) {
  const auto turned = std::count_if(edges.list.begin(), edges.list.end(), [](const ScoredEdge& e) {
    return std::abs(dot(Vec3{e.rotation[0], e.rotation[3], e.rotation[6]}, e.tangent)) < std::cos(5 * kDegree);
  });
  if (turned > 0)
    notes.push_back(fmt::format(
        "local x axis of the quaternion differs from the tangent by more than 5 deg in {} primitives", turned));
  out["nees"] = {{"dof", 4},
                 {"within_tol", score_nees_of(edges, list, truth, s, s.tolerance_mm / 1e3)},
                 {"within_gate", score_nees_of(edges, list, truth, s, s.gate_mm / 1e3)}};
  if (const auto invalid = out["nees"]["within_tol"].value("invalid_covariance", 0); invalid > 0)
    notes.push_back(fmt::format("{} judged primitives have a covariance that is not positive definite", invalid));
}

// Is a primitive with existence p correct in a share p of the cases? All states, in ten bins.
ordered_json score_existence(const ScoredEdges& edges, const std::vector<Judgement>& list) {
  struct Bin {
    double n = 0, existence = 0, correct = 0;
  };
  std::array<Bin, 10> bins{};
  double n = 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!list[i].in_region || list[i].ignored) continue;
    const double p = edges.list[i].existence;
    Bin& bin = bins[static_cast<std::size_t>(std::min(9.0, std::clamp(p, 0.0, 1.0) * 10))];
    bin.n += 1, bin.existence += p, bin.correct += list[i].correct ? 1 : 0, n += 1;
  }
  ordered_json rows = ordered_json::array();
  double error = 0;
  for (std::size_t k = 0; k < bins.size(); ++k) {
    const Bin& b = bins[k];
    if (b.n == 0) continue;
    error += b.n / n * std::abs(b.existence / b.n - b.correct / b.n);
    rows.push_back({{"bin", fmt::format("{:.1f}-{:.1f}", static_cast<double>(k) / 10, static_cast<double>(k + 1) / 10)},
                    {"n", static_cast<std::size_t>(b.n)},
                    {"mean_existence", b.existence / b.n},
                    {"fraction_correct", b.correct / b.n}});
  }
  return {
      {"n", static_cast<std::size_t>(n)}, {"ece", n > 0 ? ordered_json(error) : ordered_json(nullptr)}, {"bins", rows}};
}

ordered_json count_all(const ScoredEdges& edges, const std::vector<Judgement>& list) {
  const auto in_state = [&edges](State state) {
    return std::count_if(edges.list.begin(), edges.list.end(),
                         [state](const ScoredEdge& e) { return e.state == state; });
  };
  return {{"primitives", edges.list.size()},
          {"tentative", in_state(State::kTentative)},
          {"confirmed", in_state(State::kConfirmed)},
          {"preserved", in_state(State::kPreserved)},
          {"confirmed_used", count(list, [](const Judgement& j) { return j.used; })},
          {"outside_region", count(list, [](const Judgement& j) { return j.used && !j.in_region; })},
          {"not_judged_extra", count(list, [](const Judgement& j) { return j.used && j.in_region && j.ignored; })},
          {"judged", count(list, [](const Judgement& j) { return j.judged(); })}};
}

void explain_nothing(const std::vector<Judgement>& list, const ordered_json& result, const ScoreSettings& s,
                     std::vector<std::string>& notes) {
  const auto used = result["counts"]["confirmed_used"].get<std::size_t>();
  const auto judged = result["counts"]["judged"].get<std::size_t>();
  if (list.empty()) {
    notes.push_back("there are no primitives");
  } else if (used == 0) {
    notes.push_back(
        fmt::format("no primitive is confirmed with existence >= {}: accuracy cannot be scored", s.min_existence));
  } else if (judged == 0) {
    notes.push_back(
        "no confirmed primitive lies in the region: wrong frame or unit? (metres, in the frame of the truth)");
  } else if (result["precision"].get<double>() < 0.02) {
    notes.push_back("almost nothing lies near the truth: wrong frame, unit (metres?) or truth file?");
  }
}

}  // namespace

ordered_json score(const ScoredEdges& edges, const Truth& truth, const ScoreSettings& s,
                   std::vector<std::string> notes) {
  const std::vector<Judgement> list = judge(edges, truth, s);
  ordered_json out;
  out["settings"] = {{"tol_mm", s.tolerance_mm},
                     {"pitch_mm", s.pitch_mm},
                     {"along_mm", s.along_mm},
                     {"angle_deg", s.angle_deg},
                     {"min_existence", s.min_existence},
                     {"truth_sigma_mm", s.truth_sigma_mm},
                     {"truth_sigma_deg", s.truth_sigma_deg}};
  out["notes"] = ordered_json::array();
  out["counts"] = count_all(edges, list);
  score_accuracy(list, s, out);
  score_completeness(edges, list, *truth.edges, s, out);
  score_leakage(edges, list, truth, s, out);

  std::vector<Matched> inner;  // sides change where two segments of a line meet: judge away from the ends
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!list[i].judged() || !list[i].correct) continue;
    const Segment& segment = truth.edges->list[static_cast<std::size_t>(list[i].truth.segment)];
    const double foot = list[i].truth.foot_m, end = s.end_mm / 1e3;
    if (foot >= end && foot <= segment.length_m - end) inner.push_back({&edges.list[i], &segment});
  }
  if (edges.has_colours && truth.edges->has_colours)
    out["colour"] = score_colour(inner, edges.has_rotation && truth.edges->has_normals);
  else if (edges.has_colours)
    notes.push_back("the truth has no colours: colours not scored");
  if (edges.has_phase) out["phase"] = score_phase(inner, truth.edges->has_colours);
  if (edges.has_covariance && edges.has_rotation)
    score_nees(edges, list, truth, s, out, notes);
  else if (edges.has_covariance)
    notes.push_back("covariance without qx,qy,qz,qw: the rotation part has no axes, NEES not computed");
  out["existence"] = score_existence(edges, list);
  explain_nothing(list, out, s, notes);
  out["notes"] = notes;
  return out;
}

}  // namespace accrete::cli
