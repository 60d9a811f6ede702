#!/usr/bin/env python3
"""elementary_coefficients.py: the numbers of src/base/elementary.h and of arc_over_sine in src/math/so3.h, to 60 digits.

Each polynomial interpolates its function at the Chebyshev nodes of its interval: within a factor of two of the best one
possible. Printed: coefficients, lowest power first, and the largest error of the polynomial itself, before rounding."""
from decimal import Decimal as D, getcontext

getcontext().prec = 60


def series(term, ratio):
    """term + term*ratio(1) + term*ratio(1)*ratio(2) + ..."""
    total, n = D(0), 0
    while abs(term) > D(10) ** -70 or n < 3:
        total += term
        n += 1
        term *= ratio(n)
    return total


def atan_series(x):
    return series_odd(x, lambda n: (-1) ** n * D(1) / (2 * n + 1))


def series_odd(x, coefficient):
    total, n, power = D(0), 0, x
    while abs(power) > D(10) ** -70:
        total += coefficient(n) * power
        n, power = n + 1, power * x * x
    return total


def atan(x):
    return 2 * atan(x / (1 + (1 + x * x).sqrt())) if x > D("0.3") else atan_series(x)


PI = 16 * atan_series(D(1) / 5) - 4 * atan_series(D(1) / 239)
LN2 = 2 * series_odd(D(1) / 3, lambda n: D(1) / (2 * n + 1))


# The functions of the remainders; every one is a power series in u, so that u = 0 is harmless.
def sine(u):  # (sin x - x) / x^3, u = x^2
    return series(D(-1) / 6, lambda n: -u / ((2 * n + 2) * (2 * n + 3)))


def cosine(u):  # (cos x - 1 + x^2 / 2) / x^4
    return series(D(1) / 24, lambda n: -u / ((2 * n + 3) * (2 * n + 4)))


def arc_tangent(u):  # (atan t - t) / t^3, u = t^2
    if u < D("1e-40"):
        return D(-1) / 3
    t = u.sqrt()
    return (atan(t) - t) / (u * t)


def exponential(r):  # (e^r - 1 - r) / r^2
    return series(D(1) / 2, lambda n: r / (n + 2))


def logarithm(u):  # (log((1 + s) / (1 - s)) - 2 s) / s^3, u = s^2
    total, power = D(0), D(2)
    for n in range(60):
        total += power / (2 * n + 3)
        power *= u
    return total


def erfcx_over_t(t):  # e^(z^2) erfc(z) / t, t = 1 / (1 + z / 2)
    z = 2 * (1 - t) / t
    if z < D(3):
        erf = 2 / PI.sqrt() * series_odd_erf(z)
        return (z * z).exp() * (1 - erf) / t
    fraction = z  # continued fraction of Laplace
    for k in range(400, 0, -1):
        fraction = z + (D(k) / 2) / fraction
    return 1 / (PI.sqrt() * fraction) / t


def series_odd_erf(z):
    total, n, power = D(0), 0, z  # power = (-1)^n z^(2n+1) / n!
    while abs(power) > D(10) ** -70:
        total += power / (2 * n + 1)
        n += 1
        power *= -z * z / n
    return total


def cos(x):
    return series(D(1), lambda n: -x * x / ((2 * n - 1) * (2 * n)))


def arc_over_sine(t):  # (angle / sin(angle) - 1) / t, t = 1 - cos(angle): 1/3 + (1 2) / (3 5) t + (1 2 3) / (3 5 7) t^2 ..
    return series(D(1) / 3, lambda n: t * (n + 1) / (2 * n + 3))


def interpolate(f, low, high, degree):
    middle, half, n = (high + low) / 2, (high - low) / 2, degree + 1
    nodes = [middle + half * cos(PI * (2 * i + 1) / (2 * n)) for i in range(n)]
    divided = [f(x) for x in nodes]
    for j in range(1, n):
        for i in range(n - 1, j - 1, -1):
            divided[i] = (divided[i] - divided[i - 1]) / (nodes[i] - nodes[i - j])
    power = [D(0)] * n
    for i in range(n - 1, -1, -1):  # Horner on Newton's form
        power = [(D(0) if k == 0 else power[k - 1]) - nodes[i] * power[k] for k in range(n)]
        power[0] += divided[i]
    return power


def show(name, f, low, high, degree):
    c = interpolate(f, low, high, degree)
    worst = D(0)
    for i in range(101):
        x = low + (high - low) * i / 100
        p = D(0)
        for k in reversed(c):
            p = p * x + k
        worst = max(worst, abs(p - f(x)))
    print("%-22s error %.1e\n  {%s}" % (name, worst, ", ".join(format(k, ".17g") for k in c)))


def split(name, value, bits, parts):
    """value as a sum of numbers of so many bits, the last one of as many as fit."""
    out = []
    for _ in range(parts):
        e = 0
        while abs(value) * D(2) ** e < D(2) ** (bits - 1):
            e += 1
        while abs(value) * D(2) ** e >= D(2) ** bits:
            e -= 1
        part = (value * D(2) ** e).to_integral_value() / D(2) ** e
        out.append(part)
        value -= part
    print("%-22s %s" % (name, ", ".join(format(p, ".20g") for p in out + [value])))


if __name__ == "__main__":
    quarter = (PI / 4) ** 2
    eighth = (2 ** D("0.5") - 1) ** 2  # tan(pi / 8)^2
    s2 = ((2 ** D("0.5") - 1) / (2 ** D("0.5") + 1)) ** 2
    show("arc over sine", arc_over_sine, D(0), D(1), 8)
    for kind, degrees in (("float", (2, 2, 4, 4, 3)), ("double", (6, 6, 11, 10, 7))):
        show("sine " + kind, sine, D(0), quarter, degrees[0])
        show("cosine " + kind, cosine, D(0), quarter, degrees[1])
        show("arc tangent " + kind, arc_tangent, D(0), eighth, degrees[2])
        show("exponential " + kind, exponential, -LN2 / 2, LN2 / 2, degrees[3])
        show("logarithm " + kind, logarithm, D(0), s2, degrees[4])
    for degree in (8, 9, 10, 11):
        show("erfcx(z) / t, %d" % degree, erfcx_over_t, D("0.17"), D(1), degree)
    split("pi / 2 float", PI / 2, 12, 2)
    split("pi / 2 double", PI / 2, 33, 2)
    split("ln 2 float", LN2, 15, 1)
    split("ln 2 double", LN2, 41, 1)
    print("2 / pi %.20g  log2(e) %.20g  pi %.20g  pi/4 %.20g pi/2 %.20g" % (2 / PI, 1 / LN2, PI, PI / 4, PI / 2))
