// Which edges there are, how often each is seen, and in which colours.
#include "accrete/hal/truth.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <system_error>

#include "synthetic/recording.h"

namespace accrete::hal {
namespace synthetic {
namespace {

struct Sighting {
  int left = 0, both = 0;
  std::array<double, 3> sum_left{}, sum_right{};  // light of the two sides
  int count_left = 0, count_right = 0;
};

void add_colour(const View& view, const SceneEdge& edge, std::size_t face, const Colour& albedo,
                std::array<double, 3>& sum, int& count) {
  if (!view.faces_camera(edge.solid, face)) return;
  const Colour light = view.light(edge.solid, face, albedo);
  for (std::size_t c = 0; c < 3; ++c) sum[c] += light[c];
  ++count;
}

// Of a side that is never seen: as under ambient light with a lamp from the side.
std::array<double, 3> mean_colour(const std::array<double, 3>& sum, int count, const Colour& albedo) {
  std::array<double, 3> result{};
  for (std::size_t c = 0; c < 3; ++c) result[c] = count > 0 ? sum[c] / count : 0.6 * albedo[c];
  return result;
}

bool inside(const TruthBox& box, const Vec3& p) {
  for (std::size_t k = 0; k < 3; ++k)
    if (p[k] < box.min[k] || p[k] > box.max[k]) return false;
  return true;
}

void grow(TruthBox& box, const Vec3& p, bool first) {
  constexpr double kSpare = 0.01;  // m
  for (std::size_t k = 0; k < 3; ++k) {
    box.min[k] = first ? p[k] - kSpare : std::min(box.min[k], p[k] - kSpare);
    box.max[k] = first ? p[k] + kSpare : std::max(box.max[k], p[k] + kSpare);
  }
}

}  // namespace

Truth Recording::truth() const {
  std::vector<Sighting> sightings(scene_.edges.size());
  for (int frame = 0; frame < options_.frames; ++frame) {
    const View left = left_view(frame), right = right_view(frame);
    for (std::size_t i = 0; i < sightings.size(); ++i) {
      const SceneEdge& edge = scene_.edges[i];
      if (!left.sees(edge)) continue;
      Sighting& s = sightings[i];
      ++s.left;
      s.both += right.sees(edge) ? 1 : 0;
      add_colour(left, edge, edge.face_left, edge.left, s.sum_left, s.count_left);
      add_colour(left, edge, edge.face_right, edge.right, s.sum_right, s.count_right);
    }
  }

  const bool room = mode_ == MotionMode::kCameraMoves;
  const Stage now = stage(0);
  const Transform<Map, Object> T_m_o =
      room ? retag<Map, Object>(now.T_l_scene.inverse() * now.T_l_object) : Transform<Map, Object>{};
  Truth truth;
  truth.excluded = scene_.excluded;  // there is a gripper only where the object's frame is the map
  for (std::size_t i = 0; i < scene_.edges.size(); ++i) {
    const SceneEdge& edge = scene_.edges[i];
    const Solid& solid = scene_.solids[edge.solid];
    if (solid.carrier == Carrier::kBar) continue;  // moves in every frame: no list can hold it
    const Sighting& s = sightings[i];
    const Transform<Map, Object> T = solid.carrier == Carrier::kObject ? T_m_o : Transform<Map, Object>{};
    const Mat3 R = to_matrix(T.rotation);
    const TruthSegment segment{T * edge.p0,
                               T * edge.p1,
                               R * solid.faces[edge.face_left].normal,
                               R * solid.faces[edge.face_right].normal,
                               mean_colour(s.sum_left, s.count_left, edge.left),
                               mean_colour(s.sum_right, s.count_right, edge.right),
                               edge.kind,
                               static_cast<double>(s.left) / options_.frames,
                               static_cast<double>(s.both) / options_.frames};
    const bool gripper = edge.solid >= scene_.first_gripper && edge.solid < scene_.first_gripper + scene_.gripper_count;
    const Vec3 middle = 0.5 * (segment.p0 + segment.p1);
    const bool excluded = std::any_of(truth.excluded.begin(), truth.excluded.end(),
                                      [&](const TruthBox& box) { return inside(box, middle); });
    if (solid.carrier == Carrier::kScene && !room) {
      truth.background.push_back(segment);
    } else if (gripper || (solid.carrier == Carrier::kObject && excluded)) {
      truth.extra.push_back(segment);
    } else {
      grow(truth.bounds, segment.p0, truth.edges.empty());
      truth.edges.push_back(segment);
      grow(truth.bounds, segment.p1, false);
    }
  }
  return truth;
}

}  // namespace synthetic

namespace {

void append(std::string& text, double value, int decimals) {
  std::array<char, 64> buffer{};
  const auto [end, error] =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, decimals);
  if (error == std::errc()) text.append(buffer.data(), end);
}

template <std::size_t N>
void append(std::string& text, const std::array<double, N>& values, int decimals) {
  for (const double v : values) {
    append(text, v, decimals);
    text += ',';
  }
}

Outcome write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file)
    return {Status::kUnavailable, "cannot write " + path.string() + ": is the folder writable, the disk full?"};
  return {};
}

}  // namespace

std::string to_csv(std::span<const TruthSegment> segments) {
  std::string text =
      "x0,y0,z0,x1,y1,z1,nx,ny,nz,mx,my,mz,left_r,left_g,left_b,right_r,right_g,right_b,kind,visible,visible_both\n";
  for (const TruthSegment& s : segments) {
    append(text, s.p0, 9);
    append(text, s.p1, 9);
    append(text, s.normal, 6);
    if (s.kind == TruthKind::kCrease) {
      append(text, s.normal_right, 6);
    } else {
      text += ",,,";
    }
    append(text, s.left, 4);
    append(text, s.right, 4);
    text += s.kind == TruthKind::kCrease ? "crease," : "albedo,";
    append(text, s.visible, 4);
    text += ',';
    append(text, s.visible_both, 4);
    text += '\n';
  }
  return text;
}

Outcome write_truth(const Truth& truth, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return {Status::kUnavailable, "cannot make the folder " + folder.string() + ": " + error.message()};
  std::string box = "# xmin ymin zmin xmax ymax zmax (metres): holds all edges with 10 mm to spare\n";
  for (const double v : truth.bounds.min) append(box, v, 6), box += ' ';
  for (const double v : truth.bounds.max) append(box, v, 6), box += ' ';
  box.back() = '\n';
  Outcome outcome = write(folder / "edges.csv", to_csv(truth.edges));
  if (outcome.ok()) outcome = write(folder / "bbox.txt", box);
  if (outcome.ok() && !truth.extra.empty()) outcome = write(folder / "extra.csv", to_csv(truth.extra));
  if (outcome.ok() && !truth.background.empty()) outcome = write(folder / "background.csv", to_csv(truth.background));
  return outcome;
}

}  // namespace accrete::hal
