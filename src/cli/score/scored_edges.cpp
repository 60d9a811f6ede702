#include "cli/score/scored_edges.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <set>

#include "cli/failure.h"
#include "cli/score/csv_table.h"

namespace accrete::cli {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<const char*, 6> kColours{"left_r", "left_g", "left_b", "right_r", "right_g", "right_b"};
constexpr std::array<const char*, 4> kQuaternion{"qx", "qy", "qz", "qw"};

State parse_state(const CsvTable& table, std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (text == "tentative") return State::kTentative;
  if (text == "confirmed") return State::kConfirmed;
  if (text == "preserved") return State::kPreserved;
  throw Failure(ExitStatus::kInput,
                fmt::format("{}: unknown state '{}' (allowed: tentative, confirmed, preserved)", table.name(), text));
}

template <std::size_t N>
std::size_t count_present(const CsvTable& table, const std::array<const char*, N>& columns) {
  std::size_t n = 0;
  for (const char* column : columns) n += table.has(column) ? 1 : 0;
  return n;
}

void read_colours(const CsvTable& table, ScoredEdges& edges, std::vector<std::string>& notes) {
  const std::size_t present = count_present(table, kColours);
  edges.has_colours = present == kColours.size();
  if (!edges.has_colours) {
    if (present > 0) notes.push_back("only some of left_r .. right_b present: colours not scored");
    return;
  }
  double largest = 0;
  for (std::size_t c = 0; c < 6; ++c) {
    const std::vector<double> column = table.numbers(kColours[c]);
    for (std::size_t i = 0; i < column.size(); ++i) {
      (c < 3 ? edges.list[i].left : edges.list[i].right)[c % 3] = column[i];
      if (column[i] > largest) largest = column[i];
    }
  }
  if (largest <= 1.5) return;
  notes.push_back("colours look like 0..255; divided by 255");
  for (ScoredEdge& e : edges.list) {
    e.left = (1 / 255.0) * e.left;
    e.right = (1 / 255.0) * e.right;
  }
}

void read_rotation(const CsvTable& table, ScoredEdges& edges) {
  edges.has_rotation = count_present(table, kQuaternion) == kQuaternion.size();
  if (!edges.has_rotation) return;
  const std::vector<double> x = table.numbers("qx"), y = table.numbers("qy"), z = table.numbers("qz"),
                            w = table.numbers("qw");
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double n = std::sqrt(x[i] * x[i] + y[i] * y[i] + z[i] * z[i] + w[i] * w[i]);
    if (std::isfinite(n) && n > 1e-9)
      edges.list[i].rotation = to_matrix({x[i] / n, y[i] / n, z[i] / n, w[i] / n});
    else
      edges.list[i].rotation.fill(kNan);
  }
}

void read_covariance(const CsvTable& table, ScoredEdges& edges, std::vector<std::string>& notes) {
  std::size_t present = 0;
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) present += table.has(fmt::format("cg_{}{}", i, j)) ? 1 : 0;
  edges.has_covariance = present == 21;
  if (present > 0 && !edges.has_covariance)
    notes.push_back(fmt::format("covariance incomplete ({} of 21 columns): NEES not computed", present));
  if (!edges.has_covariance) return;
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) {
      const std::vector<double> column = table.numbers(fmt::format("cg_{}{}", i, j));
      for (std::size_t k = 0; k < column.size(); ++k)
        edges.list[k].covariance[6 * i + j] = edges.list[k].covariance[6 * j + i] = column[k];
    }
}

// Drops what cannot be judged and normalises the tangents.
void clean(ScoredEdges& edges, std::vector<std::string>& notes) {
  std::vector<ScoredEdge> kept;
  std::string first_dropped;
  double shortest = std::numeric_limits<double>::infinity(), longest = 0;
  for (ScoredEdge& e : edges.list) {
    const double length = norm(e.tangent);
    const bool good =
        std::isfinite(norm(e.position)) && std::isfinite(length) && length > 1e-9 && std::isfinite(e.existence);
    if (!good) {
      if (first_dropped.empty()) first_dropped = e.id;
      continue;
    }
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
    e.tangent = (1 / length) * e.tangent;
    kept.push_back(std::move(e));
  }
  const std::size_t dropped = edges.list.size() - kept.size();
  if (dropped > 0)
    notes.push_back(fmt::format("{} of {} primitives dropped: position, tangent or existence not finite (first id {})",
                                dropped, edges.list.size(), first_dropped));
  if (!kept.empty() && (std::abs(shortest - 1) > 1e-3 || std::abs(longest - 1) > 1e-3))
    notes.push_back(
        fmt::format("tangents are not unit vectors (length {:.4g} .. {:.4g}); normalised", shortest, longest));
  edges.list = std::move(kept);
}

}  // namespace

ScoredEdges parse_edges(std::string_view text, const std::string& name, std::vector<std::string>& notes) {
  const CsvTable table(text, name, {"id", "x", "y", "z", "tx", "ty", "tz", "existence", "state"});
  ScoredEdges edges;
  edges.list.resize(table.rows());
  const std::vector<std::string> id = table.texts("id"), state = table.texts("state");
  const std::vector<double> x = table.numbers("x"), y = table.numbers("y"), z = table.numbers("z"),
                            tx = table.numbers("tx"), ty = table.numbers("ty"), tz = table.numbers("tz"),
                            existence = table.numbers("existence");
  edges.has_phase = table.has("phase");
  const std::vector<double> phase = edges.has_phase ? table.numbers("phase") : std::vector<double>(table.rows(), kNan);
  for (std::size_t i = 0; i < edges.list.size(); ++i) {
    ScoredEdge& e = edges.list[i];
    e.id = id[i];
    e.state = parse_state(table, state[i]);
    e.existence = existence[i];
    e.position = {x[i], y[i], z[i]};
    e.tangent = {tx[i], ty[i], tz[i]};
    e.phase = phase[i];
  }
  read_colours(table, edges, notes);
  read_rotation(table, edges);
  read_covariance(table, edges, notes);
  if (const std::size_t n = std::set<std::string>(id.begin(), id.end()).size(); n != id.size())
    notes.push_back(fmt::format("ids are not unique ({} rows, {} ids)", id.size(), n));
  clean(edges, notes);
  for (const ScoredEdge& e : edges.list)
    if (e.existence < -1e-9 || e.existence > 1 + 1e-9)
      throw Failure(ExitStatus::kInput,
                    fmt::format("{}: existence must lie in 0..1, found {:.4g} (id {})", name, e.existence, e.id));
  return edges;
}

}  // namespace accrete::cli
