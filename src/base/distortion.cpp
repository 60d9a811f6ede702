#include "distortion.h"

#include <algorithm>
#include <cmath>

#include "base/elementary.h"

namespace accrete::distortion {
namespace {

// A polynomial in u = r^2 (Brown-Conrady) or theta^2 (Kannala-Brandt); both slopes fit degree 6.
constexpr int kDegree = 6;
using Polynomial = std::array<double, kDegree + 1>;

// Coefficients by name, OpenCV's order.
struct Brown {
  double k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4;
  explicit Brown(const std::array<double, 12>& c)
      : k1(c[0]),
        k2(c[1]),
        p1(c[2]),
        p2(c[3]),
        k3(c[4]),
        k4(c[5]),
        k5(c[6]),
        k6(c[7]),
        s1(c[8]),
        s2(c[9]),
        s3(c[10]),
        s4(c[11]) {}
  // The radial factor is n / d.
  [[nodiscard]] double n(double u) const { return 1 + u * (k1 + u * (k2 + u * k3)); }
  [[nodiscard]] double d(double u) const { return 1 + u * (k4 + u * (k5 + u * k6)); }
  [[nodiscard]] double dn(double u) const { return k1 + u * (2 * k2 + u * 3 * k3); }
  [[nodiscard]] double dd(double u) const { return k4 + u * (2 * k5 + u * 3 * k6); }
};

// Bernstein's test on [0, u]: a polynomial lies within the hull of its control points. All positive: no root. An end
// that is not positive: a root. Otherwise halves, down to where the two cannot be told apart.
bool positive_until(Polynomial b, int depth) {
  if (!(b.front() > 0) || !(b.back() > 0)) return false;
  if (std::all_of(b.begin(), b.end(), [](double c) { return c > 0; })) return true;
  if (depth == 0) return false;
  Polynomial left{}, right{};
  for (int i = 0; i <= kDegree; ++i) {  // de Casteljau at the middle
    left[i] = b[0];
    right[kDegree - i] = b[kDegree - i];
    for (int j = 0; j < kDegree - i; ++j) b[j] = 0.5 * (b[j] + b[j + 1]);
  }
  return positive_until(left, depth - 1) && positive_until(right, depth - 1);
}

// `a` holds powers of u; control points on [0, u]: b_i = sum_j C(i, j) / C(n, j) a_j u^j.
bool positive_on(const Polynomial& a, double u) {
  // First a bound that is nearly free and settles nearly every pixel: only falling terms can do harm, most of all at u.
  double bound = a[0], term = 1;
  for (int j = 1; j <= kDegree; ++j) {
    term *= u;
    bound += std::min(0.0, a[j] * term);
  }
  if (bound > 0) return true;
  constexpr double kBinomial[kDegree + 1] = {1, 6, 15, 20, 15, 6, 1};
  Polynomial b{};
  double power = 1;
  for (int j = 0; j <= kDegree; ++j) {
    b[j] = a[j] * power / kBinomial[j];
    power *= u;
  }
  // Multiplication by Pascal's triangle as repeated sums.
  for (int k = 0; k < kDegree; ++k)
    for (int i = kDegree; i > k; --i) b[i] += b[i - 1];
  return positive_until(b, 12);  // 2^-12 of the radius squared: an eighth of a pixel in a thousand
}

// The numerator of d(r n/d)/dr: n d + 2 u (n' d - n d'), and the denominator, which must not pass zero either.
bool brown_before_fold(const Brown& k, double u) {
  if (k.k4 == 0 && k.k5 == 0 && k.k6 == 0) return positive_on({1, 3 * k.k1, 5 * k.k2, 7 * k.k3, 0, 0, 0}, u);
  const double n[4] = {1, k.k1, k.k2, k.k3}, d[4] = {1, k.k4, k.k5, k.k6};
  Polynomial slope{};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) slope[i + j] += (1 + 2 * i - 2 * j) * n[i] * d[j];
  return positive_on(slope, u) && positive_on({d[0], d[1], d[2], d[3], 0, 0, 0}, u);
}

// d(theta_d)/d(theta) as a polynomial in theta^2.
bool kannala_before_fold(const std::array<double, 12>& k, double theta) {
  return positive_on({1, 3 * k[0], 5 * k[1], 7 * k[2], 9 * k[3], 0, 0}, theta * theta);
}

double kannala_angle(const std::array<double, 12>& k, double theta) {
  const double u = theta * theta;
  return theta * (1 + u * (k[0] + u * (k[1] + u * (k[2] + u * k[3]))));
}
double kannala_slope(const std::array<double, 12>& k, double theta) {
  const double u = theta * theta;
  return 1 + u * (3 * k[0] + u * (5 * k[1] + u * (7 * k[2] + u * 9 * k[3])));
}

Mapped distort_brown(const Brown& k, Normalized p) {
  const double x = p.x, y = p.y, u = x * x + y * y;
  const double n = k.n(u), d = k.d(u), g = n / d;
  const double dg = (k.dn(u) - g * k.dd(u)) / d;  // by u
  const double prism_x = 2 * (k.s1 + 2 * k.s2 * u), prism_y = 2 * (k.s3 + 2 * k.s4 * u);
  Mapped m;
  m.point = {x * g + 2 * k.p1 * x * y + k.p2 * (u + 2 * x * x) + u * (k.s1 + k.s2 * u),
             y * g + k.p1 * (u + 2 * y * y) + 2 * k.p2 * x * y + u * (k.s3 + k.s4 * u)};
  m.jacobian = {g + 2 * x * x * dg + 2 * k.p1 * y + 6 * k.p2 * x + prism_x * x,
                2 * x * y * dg + 2 * k.p1 * x + 2 * k.p2 * y + prism_x * y,
                2 * x * y * dg + 2 * k.p1 * x + 2 * k.p2 * y + prism_y * x,
                g + 2 * y * y * dg + 6 * k.p1 * y + 2 * k.p2 * x + prism_y * y};
  return m;
}

Mapped distort_kannala(const std::array<double, 12>& k, Normalized p) {
  const double u = p.x * p.x + p.y * p.y, r = std::sqrt(u);
  // Series of theta_d / r to second order: below 1e-5 the next term is 1e-20.
  if (r < 1e-5) {
    const double g = 1 + (k[0] - 1.0 / 3) * u;
    return {{p.x * g, p.y * g}, {g, 0, 0, g}};
  }
  const double theta = atan_of(r), g = kannala_angle(k, theta) / r;
  const double slope = kannala_slope(k, theta) / (1 + u);  // d(theta_d)/dr
  const double c = p.x / r, s = p.y / r, cross = (slope - g) * c * s;
  return {{p.x * g, p.y * g}, {slope * c * c + g * s * s, cross, cross, slope * s * s + g * c * c}};
}

// Newton's method, and where it fails bisection with Newton steps inside: `value` rises until `inside` becomes false,
// and inside(0) is true.
template <class Value, class Slope, class Inside>
double solve_rising(double target, double low, double high, Value value, Slope slope, Inside inside) {
  double x = std::min(target, high);
  for (int i = 0; i < 8; ++i) {
    const double step = (value(x) - target) / slope(x);
    x -= step;
    if (std::abs(step) <= 1e-15 * (1 + target)) break;
  }
  if (x >= low && x <= high && std::abs(value(x) - target) <= 1e-14 * (1 + target) && inside(x)) return x;
  x = std::min(target, high);
  for (int i = 0; i < 100; ++i) {
    double next = 0.5 * (low + high);
    if (!inside(x)) {
      high = x;
    } else {
      const double error = value(x) - target;
      (error < 0 ? low : high) = x;
      next = x - error / slope(x);
    }
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - x) <= 1e-15 * (1 + x)) break;
    x = next;
  }
  return x;
}

}  // namespace

Mapped distort(const Camera& camera, Normalized p) {
  switch (camera.distortion) {
    case Distortion::kBrownConrady:
      return distort_brown(Brown(camera.coefficients), p);
    case Distortion::kKannalaBrandt:
      return distort_kannala(camera.coefficients, p);
    case Distortion::kNone:
      break;
  }
  return {p, {1, 0, 0, 1}};
}

bool before_fold(const Camera& camera, Normalized p) {
  const double u = p.x * p.x + p.y * p.y;
  switch (camera.distortion) {
    case Distortion::kBrownConrady:
      return brown_before_fold(Brown(camera.coefficients), u);
    case Distortion::kKannalaBrandt:
      return kannala_before_fold(camera.coefficients, atan_of(std::sqrt(u)));
    case Distortion::kNone:
      break;
  }
  return true;
}

Normalized invert_radial(const Camera& camera, Normalized d) {
  const double target = std::sqrt(d.x * d.x + d.y * d.y);
  if (camera.distortion == Distortion::kNone || target == 0) return d;
  const auto& c = camera.coefficients;
  double r = 0;
  if (camera.distortion == Distortion::kKannalaBrandt) {
    const double theta = solve_rising(
        target, 0, 1.5707963267948966, [&](double t) { return kannala_angle(c, t); },
        [&](double t) { return kannala_slope(c, t); }, [&](double t) { return kannala_before_fold(c, t); });
    r = tan_of(theta);
  } else {
    const Brown k(c);
    r = solve_rising(
        target, 0, 64 * (1 + target), [&](double t) { return t * k.n(t * t) / k.d(t * t); },
        [&](double t) {
          const double u = t * t, g = k.n(u) / k.d(u);
          return g + 2 * u * (k.dn(u) - g * k.dd(u)) / k.d(u);
        },
        [&](double t) { return brown_before_fold(k, t * t); });
  }
  return {d.x * (r / target), d.y * (r / target)};
}

}  // namespace accrete::distortion
