// What a kind of local feature says about itself: with that, filter.h, associate.h and judge.h follow it through time
// (METHOD 10.1; docs/math/features.md has the equations). The kinds are edge.h, junction.h and patch.h.
#pragma once

#include <array>
#include <concepts>

#include "accrete/primitive.h"
#include "math/aligned.h"
#include "math/cholesky.h"
#include "math/lane_state.h"
#include "stereo/reconstruct.h"

namespace accrete::inline ACCRETE_ISA {
namespace feature {

// One aligned camera: p_c = R p + t, the camera's own offset along x already taken off.
template <class S>
struct Camera {
  Matrix3<S> R;
  Vector3<S> t;
  S focal;
};
template <class S>
std::array<Camera<S>, 2> cameras(const AlignedPose& pose, const AlignedOptics& optics) {
  const Camera<S> left{matrix_from<S>(pose.R), {S(pose.t[0]), S(pose.t[1]), S(pose.t[2])}, S(optics.focal_px)};
  Camera<S> right = left;
  right.t[0] = right.t[0] - S(optics.baseline_m);
  return {left, right};
}

// p_new = R p + t; q is R as well.
template <class S>
struct Rigid {
  Matrix3<S> R;
  Quat<S> q;
  Vector3<S> t;
};
template <class S>
ACCRETE_INLINE Vector3<S> operator*(const Rigid<S>& motion, const Vector3<S>& p) {
  Vector3<S> moved = rotate(motion.R, p);
  for (int i = 0; i < 3; ++i) moved[i] += motion.t[i];
  return moved;
}

// Beyond these no gate is tried: likelihoods are below any clutter's, and an angle so far out is another structure's.
inline constexpr float kMaxAcross = 16.0F;     // px
inline constexpr float kMaxAngle = 0.785398F;  // rad: 45 degrees
inline constexpr float kMaxSine = 0.7F;        // of about the same angle

// How many numbers describe a feature. The first three of the tangent are the position's, in the map frame or in the
// feature's own; the others are local. What is local a rigid motion leaves alone. The appearance is kPhases phases (0
// or 1), then RGB colours.
template <class F>
concept Sized = requires {
  { F::kPositionInMap } -> std::convertible_to<bool>;
  { F::kTangent } -> std::convertible_to<int>;     // degrees of freedom of an error of the geometry
  { F::kObservable } -> std::convertible_to<int>;  // of them, those that a stereo pair determines
  { F::kSpread2 } -> std::convertible_to<double>;  // squared distance of the sigma points, in variances
  { F::kAcross } -> std::convertible_to<int>;      // residuals of an eye that are px: the first ones, 1 or 2
  { F::kSenses } -> std::convertible_to<int>;      // equivalent descriptions of what an eye sees
  { F::kPhases } -> std::convertible_to<int>;
  { F::kColours } -> std::convertible_to<int>;
  { F::residuals(1) } -> std::convertible_to<int>;  // of one eye or of both
};

template <class F>
inline constexpr int kAppearance = F::kPhases + 3 * F::kColours;
template <class F>
using Appearances = std::array<float, static_cast<std::size_t>(kAppearance<F>)>;
template <class F, class S>
using StateOf = typename F::template State<S>;
template <class F, class S>
using ViewOf = typename F::template View<S>;  // what one eye sees
template <class F, class S>
using Covariance = Symmetric<S, F::kTangent>;

// In which order the root of a covariance takes the components. Any order has sigma points of the same mean and
// covariance; an edge's leaves to the last ones what no eye sees, as its kernels do (docs/math/prediction.md).
template <class F>
struct RootOrder {
  static constexpr int component(int k) { return k; }
};

// The state is a point of a manifold, and its errors are in a tangent space.
template <class F, class S>
concept Manifold = Sized<F> && requires(const StateOf<F, S>& x, Covariance<F, S>& P, S* d, const Rigid<S>& motion) {
  { F::retract(x, d) } -> std::same_as<StateOf<F, S>>;     // x [+] d
  { F::local(x, x, d) } -> std::same_as<void>;             // d with second = first [+] d
  { F::settle(P, d) } -> std::same_as<void>;               // covariance about x to that about x [+] d
  { F::moved(x, motion) } -> std::same_as<StateOf<F, S>>;  // by a rigid motion
};

// What cameras see of it, and how two views of it differ.
template <class F, class S>
concept Visible = Sized<F> &&
    requires(const StateOf<F, S>& x, const Camera<S>& camera, ViewOf<F, S>& view, const ViewOf<F, S>* views, S* r,
             Symmetric<S, F::residuals(2)>& R, S (*J)[F::kTangent]) {
  { F::look(x, camera, view) } -> std::same_as<Bool<S>>;                 // h(x); false: cannot be seen
  { F::template difference<2>(views, views, r) } -> std::same_as<void>;  // observed - predicted, angles wrapped
  { F::template noise<2>(views, R) } -> std::same_as<void>;  // covariance of the difference, of what was observed
  {
    F::observable(x, x, r, J)
    } -> std::same_as<void>;  // second - first as far as it can be seen, and d/d(error of first)
};

// Its ambiguities, and what is comparable at all.
template <class F>
concept Comparable = Sized<F> && requires(const ViewOf<F, float>& view, const Appearances<F>& seen, int sense) {
  { F::described(view, sense) } -> std::same_as<ViewOf<F, float>>;  // 0: as it is
  { F::described(seen, sense) } -> std::same_as<Appearances<F>>;
  { F::near(view, view) } -> std::same_as<bool>;  // predicted, observed: worth a gate, in this description
  { F::log_chance(1) } -> std::same_as<float>;    // log density of chance views in all residuals that are not px
};

template <class F>
concept Feature = Sized<F> && Manifold<F, float> && Visible<F, float> && Comparable<F>;

// A kind whose mean can be had from one stereo pair in closed form: `x` in the aligned left frame.
template <class F, class S>
concept Reconstructible = Visible<F, S> &&
    requires(const ViewOf<F, S>* views, const AlignedOptics& optics, StateOf<F, S>& x, const S* r, ViewOf<F, S>* out) {
  { F::reconstruct(views, optics, x) } -> std::same_as<ReconstructOutcome>;
  { F::perturbed(views, r, out) } -> std::same_as<void>;  // difference<2>(views, out) = r
};

template <class F, class S>
struct Estimate {
  StateOf<F, S> x;
  Covariance<F, S> P;
};

}  // namespace feature
}  // namespace accrete::inline ACCRETE_ISA
