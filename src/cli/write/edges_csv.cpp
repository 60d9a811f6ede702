#include "cli/write/edges_csv.h"

#include <fmt/format.h>

#include <cmath>

#include "cli/text/number.h"
#include "cli/write/snapshot.h"

namespace accrete::cli {
namespace {

constexpr const char* kColumns =
    "id,state,existence,x,y,z,qx,qy,qz,qw,tx,ty,tz,phase,left_r,left_g,left_b,right_r,right_g,right_b,observations,"
    "first_frame,last_frame,sx,sy,sz,srx,sry,srz,sphase,sleft_r,sleft_g,sleft_b,sright_r,sright_g,sright_b";

void append_triangle_names(std::string& out, const char* prefix, int n) {
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j) out += fmt::format(",{}_{}{}", prefix, i, j);
}

template <class Values>
void append_all(std::string& out, const Values& values) {
  for (const auto v : values) {
    out += ',';
    append_number(out, v);
  }
}

// Square roots of the diagonal of a packed upper triangle.
template <std::size_t N, std::size_t Packed>
void append_sigmas(std::string& out, const std::array<float, Packed>& covariance) {
  static_assert(Packed == N * (N + 1) / 2);
  for (std::size_t i = 0; i < N; ++i) {
    out += ',';
    append_number(out, std::sqrt(std::max(0.0F, covariance[packed_index(N, i, i)])));
  }
}

}  // namespace

std::string edges_csv(std::span<const Primitive3d> primitives, bool full_covariance, Encoding encoding) {
  std::string out = kColumns;
  if (full_covariance) {
    append_triangle_names(out, "cg", 6);
    append_triangle_names(out, "ca", 7);
  }
  out += '\n';
  for (const Primitive3d& primitive : primitives) {
    const Primitive3d p = in_linear_light(primitive, encoding);
    out += id_text(p.id);
    out += ',';
    out += state_text(p.state);
    append_all(out, std::array{p.existence});
    append_all(out, p.geometry.position);
    append_all(out, p.geometry.quaternion);
    append_all(out, p.tangent);
    append_all(out, std::array{p.appearance.mean.phase});
    append_all(out, p.appearance.mean.left);
    append_all(out, p.appearance.mean.right);
    append_all(out, std::array{p.observations, p.first_frame, p.last_frame});
    append_sigmas<6>(out, p.geometry.covariance);
    append_sigmas<7>(out, p.appearance.covariance);
    if (full_covariance) {
      append_all(out, p.geometry.covariance);
      append_all(out, p.appearance.covariance);
    }
    out += '\n';
  }
  return out;
}

}  // namespace accrete::cli
