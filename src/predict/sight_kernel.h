// What a camera sees of a primitive: the image of a line. It is in terms of the line's moment n = q x t, the normal of
// the plane through the line and the centre of projection: the image of the line is n.(x, y, f) = 0. So there is no
// division by a depth, and the slide along the line drops out by itself.
#pragma once

#include "math/aligned.h"
#include "math/lane_state.h"

namespace accrete::inline ACCRETE_ISA {

// A line element of one camera. `offset` is where that camera stands on the aligned x axis: 0 or the baseline.
template <class S>
struct View {
  S x, y, c, s;
  S offset;
};

// Point and own frame of the primitive, seen from the aligned left camera.
template <class S>
struct Sight {
  Vector3<S> q, t, b, a;
  Matrix3<S> own;  // from its own frame to the map
};

template <class S>
ACCRETE_INLINE Sight<S> look_at(const Vector3<S>& p, const Quat<S>& rotation, const AlignedPose& pose) {
  Sight<S> v;
  const Matrix3<S> R_a_m = matrix_from<S>(pose.R);
  v.q = rotate(R_a_m, p);
  for (int i = 0; i < 3; ++i) v.q[i] += S(pose.t[i]);
  v.own = rotation_matrix(rotation);
  v.t = rotate<S>(R_a_m, v.own.col(0));
  v.b = rotate<S>(R_a_m, v.own.col(1));
  v.a = rotate<S>(R_a_m, v.own.col(2));
  return v;
}

// n_x, n_y of the moment about the camera at (offset, 0, 0), from q x t about the left one.
template <class S>
ACCRETE_INLINE S squared_image_length(const Vector3<S>& moment, const Vector3<S>& t, S offset) {
  const S ny = moment[1] + offset * t[2];
  return moment[0] * moment[0] + ny * ny;
}

// In front of both cameras, and not a line through a centre of projection, whose image is a point: its image must be
// longer than 1e-3 of its length (0.06 degrees between line and ray).
template <class S>
ACCRETE_INLINE Bool<S> is_in_front(const Sight<S>& v, S offset) {
  const Vector3<S> n = cross(v.q, v.t);
  const S least = S(1e-6F) * v.q[2] * v.q[2];
  return (v.q[2] > S(kMinDepth_m)) & (squared_image_length(n, v.t, S(0)) > least) &
         (squared_image_length(n, v.t, offset) > least);
}

// What both cameras should see: the line elements of the projection, left and right. true where is_in_front.
template <class S>
ACCRETE_INLINE Bool<S> expected_views(const Sight<S>& v, S focal, S baseline, View<S>* views) {
  const Vector3<S> n = cross(v.q, v.t);
  const S scale = focal / v.q[2];
  for (int e = 0; e < 2; ++e) {
    const S offset = e == 0 ? S(0) : baseline;
    const S ny = n[1] + offset * v.t[2];
    const S k = inverse_sqrt(max_of(n[0] * n[0] + ny * ny, S(1e-30F)));
    views[e] = {(v.q[0] - offset) * scale, v.q[1] * scale, ny * k, -n[0] * k, offset};
  }
  return is_in_front(v, baseline);
}

}  // namespace accrete::inline ACCRETE_ISA
