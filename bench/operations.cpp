#include "operations.h"

#include <bit>
#include <cmath>
#include <cstdint>

#include "base/real.h"
#include "math/matrix.h"

namespace accrete::bench {
namespace {

Operations* counted = nullptr;

struct Counting {
  double v = 0;
  bool is_product = false;  // of two variables, not yet used

  Counting() = default;
  Counting(double x) : v(x) {}                      // NOLINT(google-explicit-constructor): scalars broadcast
  Counting(float x) : v(static_cast<double>(x)) {}  // NOLINT(google-explicit-constructor)
  Counting(int x) : v(x) {}                         // NOLINT(google-explicit-constructor)
  Counting(double x, bool product) : v(x), is_product(product) {}
};

Counting sum(const Counting& a, const Counting& b, double value) {
  ++counted->add;
  if (a.is_product || b.is_product) ++counted->fused;  // of two products only one can be fused
  return {value};
}
Counting operator+(const Counting& a, const Counting& b) { return sum(a, b, a.v + b.v); }
Counting operator-(const Counting& a, const Counting& b) { return sum(a, b, a.v - b.v); }
Counting operator*(const Counting& a, const Counting& b) {
  ++counted->multiply;
  return {a.v * b.v, true};
}
Counting operator/(const Counting& a, const Counting& b) {
  ++counted->divide;
  return {a.v / b.v};
}
Counting operator-(const Counting& a) { return {-a.v, a.is_product}; }  // a sign of a product costs nothing
Counting& operator+=(Counting& a, const Counting& b) { return a = a + b; }
bool operator<(const Counting& a, const Counting& b) { return a.v < b.v; }
bool operator>(const Counting& a, const Counting& b) { return a.v > b.v; }
bool operator>=(const Counting& a, const Counting& b) { return a.v >= b.v; }
bool operator<=(const Counting& a, const Counting& b) { return a.v <= b.v; }
bool operator==(const Counting& a, const Counting& b) { return a.v == b.v; }

Counting select(bool m, const Counting& a, const Counting& b) {
  ++counted->select;
  return m ? a : b;
}
Counting abs_of(const Counting& a) { return {std::fabs(a.v)}; }
Counting sqrt_of(const Counting& a) {
  ++counted->root;
  return {std::sqrt(a.v)};
}

}  // namespace
}  // namespace accrete::bench

template <>
struct Eigen::NumTraits<accrete::bench::Counting> : Eigen::GenericNumTraits<double> {
  using Real = accrete::bench::Counting;
  using NonInteger = accrete::bench::Counting;
  using Nested = accrete::bench::Counting;
  enum { RequireInitialization = 1 };  // NOLINT(readability-identifier-naming): the name is Eigen's
};

// The elementary functions are those of float. What they do with its bits is not counted.
template <>
struct accrete::Real<accrete::bench::Counting> {
  using S = accrete::bench::Counting;
  using Format = Binary32;
  using Int = std::int32_t;
  static Int bits(const S& x) { return std::bit_cast<Int>(static_cast<float>(x.v)); }
  static S from_bits(Int i) { return {std::bit_cast<float>(i)}; }
  static bool is_set(Int i) { return i != 0; }
  static S choose(bool m, const S& a, const S& b) { return accrete::bench::select(m, a, b); }
};

// Behind the functions that they call: names of the scalar are looked up where it is declared.
#include "associate/gate_kernel.h"
#include "filter/appearance_kernel.h"
#include "filter/reconstructed_kernel.h"
#include "filter/update_kernel.h"
#include "predict/rigid_kernel.h"

namespace accrete::bench {
namespace {

using S = Counting;

LaneState<S> some_state() {
  LaneState<S> x;
  x.p = {S(0.05), S(0.1), S(0.7)};
  x.q = {S(0.1), S(0.2), S(0.3), S(std::sqrt(1 - 0.14))};
  for (auto& v : x.P.v) v = S(1e-6);
  for (int i = 0; i < 6; ++i) x.P(i, i) = S(1e-4);
  return x;
}
View<S> some_view() { return {S(60.0), S(110.0), S(0.6), S(0.8), S(0.0)}; }

template <class Work>
Operations count(Work work) {
  Operations out;
  counted = &out;
  work(out);
  counted = nullptr;
  return out;
}

template <int Eyes>
Operations count_update() {
  return count([](Operations& out) {
    LaneState<S> x = some_state();
    const View<S> views[2] = {some_view(), some_view()};
    const S variance[4] = {S(0.09), S(1e-3), S(0.09), S(1e-3)};
    out = {};
    (void)update_geometry<Eyes>(x, views, variance, AlignedPose{}, AlignedOptics{800, 0.12F}, S(1.0));
  });
}

template <int Eyes>
Operations count_gate() {
  return count([](Operations& out) {
    associate::LanePair<Eyes, S> p;
    for (int e = 0; e < Eyes; ++e) {
      p.expected[e] = {S(60.0), S(110.0), S(0.6), S(0.8)};
      p.seen[e] = {S(60.5), S(110.0), S(0.8), S(0.6)};
      for (auto& v : p.look[e].a) v = S(0.4);
      p.look[e].sigma_phase = p.look[e].sigma_colour = S(0.1);
      p.density[e] = S(0.01);
      p.noise[2 * e] = S(0.1);
      p.noise[2 * e + 1] = S(0.001);
    }
    for (auto& v : p.P.v) v = S(1e-4);
    for (int k = 0; k < 7; ++k) p.mean[k] = p.variance[k] = S(0.3);
    p.visible = p.detection = S(0.8);
    out = {};
    (void)associate::gate_pair(p, associate::Clutter{});
    // The observations' deviations are squared by whoever loads them (src/associate/gate_pairs.cpp).
    out.multiply += 2 * Eyes, out.add += 2 * Eyes, out.fused += 2 * Eyes;
  });
}

}  // namespace

Operations operations_of_predict_state() {
  return count([](Operations& out) {
    LaneState<S> x = some_state();
    const Quat<S> q = x.q;
    const double R[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, t[3] = {};
    out = {};
    predict_rigid(x, R, q, t);
  });
}

Operations operations_of_predict_observation() {
  return count([](Operations& out) {
    LaneState<S> x = some_state();
    out = {};
    const Sight<S> sight = look_at(x.p, x.q, AlignedPose{});
    View<S> views[2];
    (void)expected_views(sight, S(800.0), S(0.12), views);
    (void)state_covariance(residual_moments<2>(sight, root_of(x.P), views, S(800.0)));
  });
}

Operations operations_of_gate() { return count_gate<2>(); }
Operations operations_of_gate_one_eye() { return count_gate<1>(); }
Operations operations_of_update_stereo() { return count_update<2>(); }
Operations operations_of_update_mono() { return count_update<1>(); }

Operations operations_of_update_reconstructed() {
  return count([](Operations& out) {
    LaneState<S> x = some_state(), z = some_state();
    out = {};
    (void)update_reconstructed(x, z);
  });
}

Operations operations_of_update_appearance() {
  return count([](Operations& out) {
    LaneAppearance<S> x;
    for (auto& v : x.P.v) v = S(1e-4);
    S z[7], noise[7], process[7];
    for (int i = 0; i < 7; ++i) {
      x.mean[i] = z[i] = S(0.5);
      x.P(i, i) = noise[i] = process[i] = S(1e-2);
    }
    out = {};
    (void)update_appearance(x, z, noise, process);
  });
}

}  // namespace accrete::bench
