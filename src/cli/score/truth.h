// What is known about a scene beforehand: exact edge segments, boxes and faces, in metres, in the frame of edges.csv.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "accrete/geometry.h"

namespace accrete::cli {

struct Segment {
  Vec3 p{}, q{};     // ends
  Vec3 direction{};  // unit, p to q
  double length_m = 0;
  bool visible = true;   // in any frame; an edge that was never seen is not missed
  Vec3 left{}, right{};  // colours 0..1 met when walking p -> q and looking against the normal; NaN where unknown
  Vec3 normal{};         // towards the viewer: right = direction x normal
  std::string kind;
};

struct Segments {
  std::vector<Segment> list;
  bool has_colours = false, has_normals = false, has_kinds = false;
};

struct Box {
  Vec3 min{}, max{};

  [[nodiscard]] bool contains(const Vec3& p, double margin_m = 0) const {
    for (int i = 0; i < 3; ++i)
      if (!(p[i] >= min[i] - margin_m && p[i] <= max[i] + margin_m)) return false;
    return true;
  }
};

using Quad = std::array<Vec3, 4>;

// Columns x0,y0,z0,x1,y1,z1[,left,right | ,left_r..right_b][,nx,ny,nz][,visible][,kind]. Throws Failure(kInput): no
// segment, a coordinate that is missing or not finite, a segment without length.
[[nodiscard]] Segments parse_segments(std::string_view text, const std::string& name);
// Six numbers xmin ymin zmin xmax ymax zmax, lines with # skipped. Throws Failure(kInput) otherwise.
[[nodiscard]] Box parse_box(std::string_view text, const std::string& name);
// Columns x0..z0,..,x3..z3[,name]: planar quads in order round the border.
[[nodiscard]] std::vector<Quad> parse_faces(std::string_view text, const std::string& name);

// The files of a recording's truth folder; what is not there stays empty.
struct Truth {
  std::optional<Segments> edges;  // edges.csv: to be found
  std::optional<Segments> extra;  // extra.csv: real, but without exact truth; what lies nearest to them is not judged
  std::optional<Segments> background;  // background.csv: must not appear
  std::optional<Box> region;           // region.txt: the truth is complete in here
  std::optional<Box> bbox;             // bbox.txt: the object lies in here
  std::vector<Quad> faces;             // faces.csv: the object's surface
};

// Reads what is there of the six files; throws Failure(kInput) when one is damaged.
[[nodiscard]] Truth read_truth(const std::filesystem::path& folder);

}  // namespace accrete::cli
