#include "cli/write/ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "accrete/version.h"
#include "cli/write/snapshot.h"

namespace accrete::cli {
namespace {

using Point = std::array<float, 3>;
using Rgb = std::array<std::uint8_t, 3>;

void append(std::string& out, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>((value >> shift) & 0xFFU);
}
void append(std::string& out, float value) { append(out, std::bit_cast<std::uint32_t>(value)); }
void append(std::string& out, std::uint8_t value) { out += static_cast<char>(value); }

template <class T, std::size_t N>
void append(std::string& out, const std::array<T, N>& values) {
  for (const T v : values) append(out, v);
}

std::uint8_t to_byte(float colour) {
  return static_cast<std::uint8_t>(std::lround(255 * (std::isfinite(colour) ? std::clamp(colour, 0.0F, 1.0F) : 0.0F)));
}
Rgb to_rgb(const std::array<float, 3>& c) { return {to_byte(c[0]), to_byte(c[1]), to_byte(c[2])}; }
Rgb mean_rgb(const Appearance& a) {
  return to_rgb({(a.left[0] + a.right[0]) / 2, (a.left[1] + a.right[1]) / 2, (a.left[2] + a.right[2]) / 2});
}

Point shifted(const Point& p, float s, const Point& d) { return {p[0] + s * d[0], p[1] + s * d[1], p[2] + s * d[2]}; }

// Local y axis in the map frame: towards the right-hand side.
Point to_the_right(const Geometry& g) {
  const Mat3 r = to_matrix({g.quaternion[0], g.quaternion[1], g.quaternion[2], g.quaternion[3]});
  return {static_cast<float>(r[1]), static_cast<float>(r[4]), static_cast<float>(r[7])};
}

std::string header(MotionMode mode, const char* what) {
  return fmt::format("ply\nformat binary_little_endian 1.0\ncomment accrete {}: {}\ncomment metres, {} frame\n",
                     kVersion, what, frame_text(mode));
}

constexpr const char* kPosition = "property float x\nproperty float y\nproperty float z\n";
constexpr const char* kColour = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
constexpr std::array kScalars{"existence", "phase",    "observations", "sx",      "sy",      "sz",
                              "srx",       "sry",      "srz",          "sphase",  "sleft_r", "sleft_g",
                              "sleft_b",   "sright_r", "sright_g",     "sright_b"};

}  // namespace

std::string edges_ply(std::span<const Primitive3d> primitives, MotionMode mode) {
  std::string out =
      header(mode, "points on edges, the normal is the unit tangent, s* are standard deviations (m, rad, 0..1)");
  out += fmt::format("element vertex {}\n{}property float nx\nproperty float ny\nproperty float nz\n{}",
                     primitives.size(), kPosition, kColour);
  for (const char* name : kScalars) out += fmt::format("property float {}\n", name);
  out += "end_header\n";
  for (const Primitive3d& p : primitives) {
    append(out, p.geometry.position);
    append(out, p.tangent);
    append(out, mean_rgb(p.appearance.mean));
    append(out, p.existence);
    append(out, p.appearance.mean.phase);
    append(out, static_cast<float>(p.observations));
    for (std::size_t i = 0; i < 6; ++i)
      append(out, std::sqrt(std::max(0.0F, p.geometry.covariance[packed_index(6, i, i)])));
    for (std::size_t i = 0; i < 7; ++i)
      append(out, std::sqrt(std::max(0.0F, p.appearance.covariance[packed_index(7, i, i)])));
  }
  return out;
}

std::string lines_ply(std::span<const Primitive3d> primitives, MotionMode mode) {
  std::string out = header(mode, "a short line for each primitive");
  out +=
      fmt::format("element vertex {}\n{}{}element edge {}\nproperty int vertex1\nproperty int vertex2\n{}end_header\n",
                  2 * primitives.size(), kPosition, kColour, primitives.size(), kColour);
  const std::vector<float> half = half_lengths_m(primitives);
  for (std::size_t i = 0; i < primitives.size(); ++i)
    for (const float end : {-half[i], half[i]}) {
      append(out, shifted(primitives[i].geometry.position, end, primitives[i].tangent));
      append(out, mean_rgb(primitives[i].appearance.mean));
    }
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    append(out, static_cast<std::uint32_t>(2 * i));
    append(out, static_cast<std::uint32_t>(2 * i + 1));
    append(out, mean_rgb(primitives[i].appearance.mean));
  }
  return out;
}

std::string ribbons_ply(std::span<const Primitive3d> primitives, MotionMode mode) {
  std::string out = header(mode, "a thin quad for each primitive in the colours of its two sides");
  out += fmt::format("element vertex {}\n{}{}element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                     8 * primitives.size(), kPosition, kColour, 4 * primitives.size());
  const std::vector<float> half = half_lengths_m(primitives);
  constexpr float kAspect = 0.3F;  // half a ribbon's width over half its length: thin, yet both colours show
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const Primitive3d& p = primitives[i];
    const Point right = to_the_right(p.geometry);
    for (const float side : {-1.0F, 1.0F})
      for (const float end : {-1.0F, 1.0F})
        for (const float across :
             {0.0F, side}) {  // order: 0 back centre, 1 back border, 2 front centre, 3 front border
          const Point on_axis = shifted(p.geometry.position, end * half[i], p.tangent);
          append(out, shifted(on_axis, across * kAspect * half[i], right));
          append(out, to_rgb(side < 0 ? p.appearance.mean.left : p.appearance.mean.right));
        }
  }
  for (std::size_t i = 0; i < primitives.size(); ++i)
    for (const bool left : {true, false}) {
      // Counter-clockwise for the viewer: (b - a) x (c - a) is minus local z.
      const auto v = static_cast<std::uint32_t>(8 * i + (left ? 0 : 4));
      const std::array<std::array<std::uint32_t, 3>, 2> faces =
          left ? std::array<std::array<std::uint32_t, 3>, 2>{{{v, v + 2, v + 1}, {v + 2, v + 3, v + 1}}}
               : std::array<std::array<std::uint32_t, 3>, 2>{{{v, v + 1, v + 2}, {v + 2, v + 1, v + 3}}};
      for (const auto& face : faces) {
        append(out, std::uint8_t{3});
        append(out, face);
      }
    }
  return out;
}

}  // namespace accrete::cli
