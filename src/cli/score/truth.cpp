#include "cli/score/truth.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "cli/failure.h"
#include "cli/score/csv_table.h"
#include "cli/text/file.h"
#include "cli/text/number.h"

namespace accrete::cli {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  throw Failure(ExitStatus::kInput, name + ": " + what);
}

bool finite(const Vec3& v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

bool has_all(const CsvTable& table, const std::array<const char*, 3>& columns) {
  return table.has(columns[0]) && table.has(columns[1]) && table.has(columns[2]);
}

std::vector<Vec3> vectors(const CsvTable& table, const std::array<const char*, 3>& columns) {
  std::vector<Vec3> out(table.rows());
  for (int i = 0; i < 3; ++i) {
    const std::vector<double> column = table.numbers(columns[i]);
    for (std::size_t row = 0; row < out.size(); ++row) out[row][i] = column[row];
  }
  return out;
}

void read_colours(const CsvTable& table, Segments& segments) {
  std::vector<Vec3> left, right;
  if (has_all(table, {"left_r", "left_g", "left_b"}) && has_all(table, {"right_r", "right_g", "right_b"})) {
    left = vectors(table, {"left_r", "left_g", "left_b"});
    right = vectors(table, {"right_r", "right_g", "right_b"});
  } else if (table.has("left") && table.has("right") && table.is_numeric("left") && table.is_numeric("right")) {
    left = vectors(table, {"left", "left", "left"});
    right = vectors(table, {"right", "right", "right"});
  } else {
    return;
  }
  segments.has_colours = true;
  for (std::size_t i = 0; i < segments.list.size(); ++i) {
    segments.list[i].left = left[i];
    segments.list[i].right = right[i];
  }
}

}  // namespace

Segments parse_segments(std::string_view text, const std::string& name) {
  const CsvTable table(text, name, {"x0", "y0", "z0", "x1", "y1", "z1"});
  if (table.rows() == 0) fail(name, "no segments");
  const std::vector<Vec3> p = vectors(table, {"x0", "y0", "z0"}), q = vectors(table, {"x1", "y1", "z1"});
  Segments segments;
  segments.list.resize(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    Segment& s = segments.list[i];
    if (!finite(p[i]) || !finite(q[i]))
      fail(name, fmt::format("segment {}: a coordinate is missing or not finite", i + 1));
    s.p = p[i];
    s.q = q[i];
    s.length_m = norm(q[i] - p[i]);
    if (!(s.length_m > 0)) fail(name, fmt::format("segment {} has no length", i + 1));
    s.direction = (1 / s.length_m) * (q[i] - p[i]);
    s.left = s.right = s.normal = {kNan, kNan, kNan};
  }
  read_colours(table, segments);
  if (has_all(table, {"nx", "ny", "nz"})) {
    segments.has_normals = true;
    const std::vector<Vec3> normals = vectors(table, {"nx", "ny", "nz"});
    for (std::size_t i = 0; i < p.size(); ++i) segments.list[i].normal = normals[i];
  }
  if (table.has("visible")) {
    const std::vector<double> visible = table.numbers("visible");
    for (std::size_t i = 0; i < p.size(); ++i) segments.list[i].visible = visible[i] > 0;
  }
  if (table.has("kind")) {
    segments.has_kinds = true;
    const std::vector<std::string> kinds = table.texts("kind");
    for (std::size_t i = 0; i < p.size(); ++i) segments.list[i].kind = kinds[i];
  }
  return segments;
}

Box parse_box(std::string_view text, const std::string& name) {
  std::vector<double> values;
  bool good = true;
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size());
    std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.starts_with('#')) continue;
    while (!line.empty()) {
      const auto blank = std::min(line.find_first_of(" \t"), line.size());
      double value = 0;
      good = good && parse_number(line.substr(0, blank), value) && std::isfinite(value);
      values.push_back(value);
      line = trimmed(line.substr(blank));
    }
  }
  good = good && values.size() == 6;
  for (std::size_t i = 0; good && i < 3; ++i) good = values[i + 3] > values[i];
  if (!good) fail(name, "needs six numbers xmin ymin zmin xmax ymax zmax with max > min");
  return {{values[0], values[1], values[2]}, {values[3], values[4], values[5]}};
}

std::vector<Quad> parse_faces(std::string_view text, const std::string& name) {
  const CsvTable table(text, name, {"x0", "y0", "z0", "x1", "y1", "z1", "x2", "y2", "z2", "x3", "y3", "z3"});
  const std::array<std::vector<Vec3>, 4> corners{vectors(table, {"x0", "y0", "z0"}), vectors(table, {"x1", "y1", "z1"}),
                                                 vectors(table, {"x2", "y2", "z2"}),
                                                 vectors(table, {"x3", "y3", "z3"})};
  std::vector<Quad> quads(table.rows());
  for (std::size_t i = 0; i < quads.size(); ++i) {
    for (int k = 0; k < 4; ++k) quads[i][k] = corners[k][i];
    const Vec3 n = cross(quads[i][1] - quads[i][0], quads[i][3] - quads[i][0]);
    if (!finite(n) || !(norm(n) > 0)) fail(name, fmt::format("face {} has no area", i + 1));
  }
  return quads;
}

Truth read_truth(const std::filesystem::path& folder) {
  Truth truth;
  const auto with = [&folder](const char* file, auto&& parse) {
    const std::filesystem::path path = folder / file;
    std::error_code unknown;
    const bool there = std::filesystem::exists(path, unknown);
    if (unknown) fail(path.string(), "cannot be looked for: " + unknown.message());
    if (there) parse(read_text_file(path), path.string());
  };
  with("edges.csv", [&](const std::string& t, const std::string& n) { truth.edges = parse_segments(t, n); });
  with("extra.csv", [&](const std::string& t, const std::string& n) { truth.extra = parse_segments(t, n); });
  with("background.csv", [&](const std::string& t, const std::string& n) { truth.background = parse_segments(t, n); });
  with("region.txt", [&](const std::string& t, const std::string& n) { truth.region = parse_box(t, n); });
  with("bbox.txt", [&](const std::string& t, const std::string& n) { truth.bbox = parse_box(t, n); });
  with("faces.csv", [&](const std::string& t, const std::string& n) { truth.faces = parse_faces(t, n); });
  return truth;
}

}  // namespace accrete::cli
