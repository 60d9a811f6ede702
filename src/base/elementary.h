// Sine, cosine, arc tangent, exponential and logarithm of our own: the same bits on every machine, because nothing but
// IEEE addition, multiplication, division and square root is in them, and no branch, so that lanes have them as well.
// Mathematics, domains and measured errors: docs/math/elementary.md. The coefficients come from
// tests/numeric/elementary_coefficients.py. S: float, double or a pack of float lanes.
#pragma once

#include "base/real.h"

namespace accrete {
namespace elementary {

template <class S, std::size_t N>
S polynomial(const double (&c)[N], S u) {
  using Scalar = typename Real<S>::Format::Scalar;
  S sum = S(static_cast<Scalar>(c[N - 1]));
  for (std::size_t i = N - 1; i-- > 0;) sum = sum * u + S(static_cast<Scalar>(c[i]));
  return sum;
}

template <class Format>
struct Numbers;
template <>
struct Numbers<Binary32> {
  static constexpr double kSine[] = {-0.16666664662314379, 0.0083327482706297495, -0.00019587890880412386};
  static constexpr double kCosine[] = {0.041666664659502207, -0.0013888303035894866, 0.000024547942085071573};
  static constexpr double kArcTangent[] = {-0.33333331761168520, 0.19999540483648963, -0.14263955597984639,
                                           0.10743731490791083, -0.064519282081217488};
  static constexpr double kExponential[] = {0.5, 0.16666577025597988, 0.041666554662050534, 0.0083631730745137109,
                                            0.0013926176119935579};
  static constexpr double kLogarithm[] = {0.66666666554497092, 0.40000121839806127, 0.28550820815960663,
                                          0.23330467216303836};
  // pi / 2 in parts of 12 bits: their products with a number of turns up to 2^12 are exact.
  static constexpr float kHalfPi[] = {1.57080078125F, -4.4535845518112182617e-6F, -8.7055156955041658961e-10F};
  static constexpr float kMaxAngle = 4096;
  static constexpr float kLn2[] = {0.693145751953125F, 1.4286068203094172321e-6F};  // 15 bits, and the rest
  static constexpr float kExpMin = -87.33654F, kExpMax = 88.72283F;  // logs of 2^-126, and of the largest
};
template <>
struct Numbers<Binary64> {
  static constexpr double kSine[] = {-0.16666666666666667,   0.0083333333333333315,  -0.00019841269841265065,
                                     2.7557319219339167e-6,  -2.5052106232447577e-8, 1.6058531618986147e-10,
                                     -7.5866971177069180e-13};
  static constexpr double kCosine[] = {0.041666666666666667,   -0.0013888888888888888, 0.000024801587301584646,
                                       -2.7557319221402824e-7, 2.0876755791080424e-9,  -1.1470460887609959e-11,
                                       4.7458719020432915e-14};
  static constexpr double kArcTangent[] = {-0.33333333333333333,  0.19999999999999805,   -0.14285714285659828,
                                           0.11111111105155447,   -0.090909087535008768, 0.076922963750321424,
                                           -0.066664248857382553, 0.058789289978347751,  -0.052304542706502445,
                                           0.045515932206265492,  -0.034570561981427747, 0.016285756855221028};
  static constexpr double kExponential[] = {0.5,
                                            0.16666666666666671,
                                            0.041666666666666670,
                                            0.0083333333333261409,
                                            0.0013888888888883752,
                                            0.00019841269874800492,
                                            0.000024801587325533364,
                                            2.7557255425746434e-6,
                                            2.7557273661348636e-7,
                                            2.5105206373957011e-8,
                                            2.0914679376583935e-9};
  static constexpr double kLogarithm[] = {0.66666666666666666, 0.40000000000000877, 0.28571428570803612,
                                          0.22222222391713917, 0.18181795640132906, 0.15386239702814658,
                                          0.13268773138656885, 0.13086626147840102};
  // 33 bits: up to 2^20 turns.
  static constexpr double kHalfPi[] = {1.5707963267341256142, 6.0771005063039659766e-11, 2.0222662487959507324e-21};
  static constexpr double kMaxAngle = 1e6;
  static constexpr double kLn2[] = {0.69314718056011770386, -1.7239444525614834773e-13};  // 41 bits, and the rest
  static constexpr double kExpMin = -708.3964185322641, kExpMax = 709.782712893384;
};

template <class S>
using NumbersOf = Numbers<typename Real<S>::Format>;

}  // namespace elementary

template <class S>
struct SineCosine {
  S sine, cosine;
};
// Of an angle up to kMaxAngle in magnitude; beyond, the sine is 0 and the cosine 1. NaN and infinity: NaN. An angle
// below the smallest normal number is zero.
template <class S>
SineCosine<S> sine_cosine(S angle) {
  using R = Real<S>;
  using K = elementary::NumbersOf<S>;
  const auto large = (angle > S(K::kMaxAngle)) | (angle < S(-K::kMaxAngle));
  const auto tiny = (angle < S(R::Format::kSmallest)) & (angle > S(-R::Format::kSmallest));
  // NOLINTNEXTLINE(misc-redundant-expression): zero, but NaN where the angle is infinite
  const S x = R::choose(large | tiny, angle - angle, angle);
  // Reduction by multiples of pi / 2 after Cody and Waite: the products are exact, so is the first difference.
  const S shifted = x * S(0.63661977236758138) + S(R::Format::kShift);
  const S turns = shifted - S(R::Format::kShift);
  const S r = ((x - turns * S(K::kHalfPi[0])) - turns * S(K::kHalfPi[1])) - turns * S(K::kHalfPi[2]);
  const S u = r * r;
  const S s = r + r * u * elementary::polynomial(K::kSine, u);
  const S c = (S(1) - S(0.5F) * u) + u * u * elementary::polynomial(K::kCosine, u);
  const auto quadrant = R::bits(shifted);
  const auto odd = R::is_set(quadrant & 1);
  const S sine = R::choose(odd, c, s), cosine = R::choose(odd, s, c);
  return {R::choose(R::is_set(quadrant & 2), -sine, sine), R::choose(R::is_set((quadrant + 1) & 2), -cosine, cosine)};
}
template <class S>
S sin_of(S angle) {
  return sine_cosine(angle).sine;
}
template <class S>
S cos_of(S angle) {
  return sine_cosine(angle).cosine;
}

// Direction of (x, y), -pi .. pi. Zeros have no sign, and what is below the smallest normal number is one: (x > 0, 0)
// gives 0, (x < 0, 0) gives pi, (0, 0) gives 0. Infinities count as 1e37, where larger numbers end. NaN: NaN.
template <class S>
S atan2_of(S y, S x) {
  using R = Real<S>;
  using K = elementary::NumbersOf<S>;
  const S largest = S(1e37F), smallest = S(R::Format::kSmallest);
  const auto magnitude = [&](S v) {
    const S m = R::choose(v < S(0), -v, v);
    const S bounded = R::choose(m > largest, largest, m);
    return R::choose(bounded < smallest, S(0), bounded);
  };
  const S ax = magnitude(x), ay = magnitude(y);
  const auto steep = ay > ax;
  const S a = R::choose(steep, ax, ay), b = R::choose(steep, ay, ax);
  // tan(pi/4 - t) of the upper half: one division, and an argument of at most tan(pi/8).
  const auto upper = a > S(0.41421356237309503) * b;
  const S numerator = R::choose(upper, a - b, a), denominator = R::choose(upper, a + b, b);
  const S quotient = numerator / R::choose(denominator > S(0), denominator, S(1));
  const S t = R::choose((quotient < smallest) & (quotient > -smallest), S(0), quotient);
  const S square = R::choose((t < S(1e-9F)) & (t > S(-1e-9F)), S(0), t) * t;
  S angle = t + t * square * elementary::polynomial(K::kArcTangent, square);
  angle = R::choose(upper, S(0.78539816339744831) + angle, angle);
  angle = R::choose(steep, S(1.5707963267948966) - angle, angle);
  angle = R::choose(x <= -smallest, S(3.1415926535897932) - angle, angle);
  angle = R::choose(y <= -smallest, -angle, angle);
  return R::choose((x == x) & (y == y), angle, x + y);  // NOLINT(misc-redundant-expression): false for NaN
}

template <class S>
S atan_of(S x) {
  return atan2_of(x, S(1));
}
template <class S>
S tan_of(S angle) {
  const SineCosine<S> v = sine_cosine(angle);
  return v.sine / v.cosine;
}

// Of -1 .. 1, bounded to it. NaN: NaN.
template <class S>
S acos_of(S c) {
  c = Real<S>::choose(c > S(1), S(1), Real<S>::choose(c < S(-1), S(-1), c));
  return atan2_of(Real<S>::root((S(1) - c) * (S(1) + c)), c);
}
template <class S>
S asin_of(S s) {
  s = Real<S>::choose(s > S(1), S(1), Real<S>::choose(s < S(-1), S(-1), s));
  return atan2_of(s, Real<S>::root((S(1) - s) * (S(1) + s)));
}

// Zero below the logarithm of the smallest normal number, infinity above that of the largest. NaN: NaN.
template <class S>
S exp_of(S x) {
  using R = Real<S>;
  using K = elementary::NumbersOf<S>;
  using Int = typename R::Int;
  const auto low = x<S(K::kExpMin), high = x> S(K::kExpMax);
  const S v = R::choose(low | high, S(0), x);
  const S shifted = v * S(1.4426950408889634) + S(R::Format::kShift);
  const S k = shifted - S(R::Format::kShift);
  const S r = (v - k * S(K::kLn2[0])) - k * S(K::kLn2[1]);
  const S e = S(1) + (r + r * r * elementary::polynomial(K::kExponential, r));
  // 2^k in two factors, so that neither leaves the range of normal numbers.
  const Int whole = R::bits(shifted) - R::bits(S(R::Format::kShift));
  const Int half = whole >> 1;
  const auto power = [](Int n) { return R::from_bits((n + R::Format::kBias) << R::Format::kFraction); };
  const S y = e * power(half) * power(whole - half);
  return R::choose(low, S(0), R::choose(high, S(R::Format::kInfinity), y));
}

// Natural logarithm. -infinity of zero and of what is smaller than the smallest normal number; NaN below and of NaN;
// infinity of infinity.
template <class S>
S log_of(S x) {
  using R = Real<S>;
  using K = elementary::NumbersOf<S>;
  using Int = typename R::Int;
  const auto usable = (x >= S(R::Format::kSmallest)) & (x < S(R::Format::kInfinity));
  // x = m 2^k with m in sqrt(1/2) .. sqrt(2): subtracting the bits of sqrt(1/2) carries into the exponent in time.
  const Int bits = R::bits(R::choose(usable, x, S(1)));
  const Int k = (bits - R::bits(S(0.70710678118654752))) >> R::Format::kFraction;
  const S f = R::from_bits(bits - (k << R::Format::kFraction)) - S(1);
  const S whole = R::from_bits(k + R::bits(S(R::Format::kShift))) - S(R::Format::kShift);
  // log(1 + f) = 2 s + s^3 L(s^2) with s = f / (2 + f), and 2 s = f - s f: what is large is exact.
  const S s = f / (S(2) + f), u = s * s, half_square = S(0.5F) * f * f;
  const S rest = s * (half_square + u * elementary::polynomial(K::kLogarithm, u));
  const S y = whole * S(K::kLn2[0]) - ((half_square - (rest + whole * S(K::kLn2[1]))) - f);
  const S below = R::choose(x > S(-R::Format::kSmallest), S(-R::Format::kInfinity), S(__builtin_nanf("")));
  return R::choose(usable, y, R::choose(x >= S(R::Format::kSmallest), x, below));
}

template <class S>
S hypot_of(S x, S y) {  // for lengths whose squares are normal numbers
  return Real<S>::root(x * x + y * y);
}

// Distribution function of the standard normal distribution; 0 where it is below the smallest normal number. Single
// precision.
template <class S>
S normal_cdf_of(S x) {
  // erfc(z) = t Q(t) exp(-z^2) for z >= 0, t = 1 / (1 + z / 2).
  constexpr double kErfc[] = {0.28208500033363251,  0.28233765747074475,  0.24429089020294225,   0.19084146810295831,
                              0.035394138997204203, 0.083038484570631591, -0.099779966849924045, -0.20548318025682204,
                              0.32371595552041724,  -0.16828494869883727, 0.031844502512827905};
  using R = Real<S>;
  const S scaled = x * S(0.70710678118654752);
  const S z = R::choose(scaled < S(0), -scaled, scaled);
  const S t = S(1) / (S(1) + S(0.5F) * z);
  const S product = S(0.5F) * (exp_of(-(z * z)) * (t * elementary::polynomial(kErfc, t)));
  const S tail = R::choose(product < S(R::Format::kSmallest), S(0), product);
  return R::choose(x < S(0), tail, S(1) - tail);
}

}  // namespace accrete
