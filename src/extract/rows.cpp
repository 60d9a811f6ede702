#include "extract/rows.h"

namespace accrete::extract::inline ACCRETE_ISA {

#define ACCRETE_RESTRICT __restrict

void load_grey(const std::uint8_t* ACCRETE_RESTRICT pixels, int width, float* ACCRETE_RESTRICT out) {
  for (int x = 0; x < width; ++x) out[x] = static_cast<float>(pixels[x]);
}

void load_colour(const std::uint8_t* ACCRETE_RESTRICT pixels, int width, const float* weights,
                 float* ACCRETE_RESTRICT out) {
  const float w0 = weights[0], w1 = weights[1], w2 = weights[2];
  for (int x = 0; x < width; ++x)
    out[x] = w0 * static_cast<float>(pixels[3 * x]) + w1 * static_cast<float>(pixels[3 * x + 1]) +
             w2 * static_cast<float>(pixels[3 * x + 2]);
}

void round_to_bytes(const float* ACCRETE_RESTRICT in, int width, std::uint8_t* ACCRETE_RESTRICT out) {
  constexpr float kHalf = 0.5F;  // std::lround would be a call for every pixel
  // Through int: compilers vectorise that conversion alone.
  for (int x = 0; x < width; ++x) out[x] = static_cast<std::uint8_t>(static_cast<int>(in[x] + kHalf));
}

// Folded: the four passes share the sums and differences of mirrored pixels.
void filter_along(const float* ACCRETE_RESTRICT r, int width, float* const* out) {
  constexpr Kernels k = kKernels;
  float *ACCRETE_RESTRICT g1 = out[kGauss1], *ACCRETE_RESTRICT g2 = out[kGauss2], *ACCRETE_RESTRICT odd = out[kOdd],
                          *ACCRETE_RESTRICT smooth = out[kSmooth];
  for (int x = 0; x < width; ++x) {
    const float z = r[x];
    const float p1 = r[x + 1] + r[x - 1], p2 = r[x + 2] + r[x - 2], p3 = r[x + 3] + r[x - 3], p4 = r[x + 4] + r[x - 4];
    const float m1 = r[x + 1] - r[x - 1], m2 = r[x + 2] - r[x - 2], m3 = r[x + 3] - r[x - 3], m4 = r[x + 4] - r[x - 4];
    g1[x] = k.gauss1[0] * z + k.gauss1[1] * p1 + k.gauss1[2] * p2 + k.gauss1[3] * p3 + k.gauss1[4] * p4;
    g2[x] = k.gauss2[0] * z + k.gauss2[1] * p1 + k.gauss2[2] * p2 + k.gauss2[3] * p3 + k.gauss2[4] * p4;
    odd[x] = k.odd[1] * m1 + k.odd[2] * m2 + k.odd[3] * m3 + k.odd[4] * m4;
    smooth[x] = k.smooth[0] * z + k.smooth[1] * p1 + k.smooth[2] * p2 + k.smooth[3] * p3 + k.smooth[4] * p4;
  }
}

// The taps are written out, and what is written comes in as parameters: compilers vectorise this form alone.
void filter_across(const float* const (*rows)[kTaps], int width, float* ACCRETE_RESTRICT even,
                   float* ACCRETE_RESTRICT odd_x, float* ACCRETE_RESTRICT odd_y, float* ACCRETE_RESTRICT energy) {
  constexpr Kernels k = kKernels;
  const auto& a = rows[kGauss1];
  const auto& b = rows[kGauss2];
  const float *a0 = a[0], *a1 = a[1], *a2 = a[2], *a3 = a[3], *a4 = a[4], *a5 = a[5], *a6 = a[6], *a7 = a[7],
              *a8 = a[8];
  const float *b0 = b[0], *b1 = b[1], *b2 = b[2], *b3 = b[3], *b4 = b[4], *b5 = b[5], *b6 = b[6], *b7 = b[7],
              *b8 = b[8];
  for (int x = 0; x < width; ++x)
    even[x] = k.gauss1[0] * a4[x] + k.gauss1[1] * (a3[x] + a5[x]) + k.gauss1[2] * (a2[x] + a6[x]) +
              k.gauss1[3] * (a1[x] + a7[x]) + k.gauss1[4] * (a0[x] + a8[x]) -
              (k.gauss2[0] * b4[x] + k.gauss2[1] * (b3[x] + b5[x]) + k.gauss2[2] * (b2[x] + b6[x]) +
               k.gauss2[3] * (b1[x] + b7[x]) + k.gauss2[4] * (b0[x] + b8[x]));
  const auto& c = rows[kOdd];
  const auto& d = rows[kSmooth];
  const float *c0 = c[0], *c1 = c[1], *c2 = c[2], *c3 = c[3], *c4 = c[4], *c5 = c[5], *c6 = c[6], *c7 = c[7],
              *c8 = c[8];
  const float *d0 = d[0], *d1 = d[1], *d2 = d[2], *d3 = d[3], *d5 = d[5], *d6 = d[6], *d7 = d[7], *d8 = d[8];
  for (int x = 0; x < width; ++x) {
    const float u = k.smooth[0] * c4[x] + k.smooth[1] * (c3[x] + c5[x]) + k.smooth[2] * (c2[x] + c6[x]) +
                    k.smooth[3] * (c1[x] + c7[x]) + k.smooth[4] * (c0[x] + c8[x]);
    const float v = k.odd[1] * (d5[x] - d3[x]) + k.odd[2] * (d6[x] - d2[x]) + k.odd[3] * (d7[x] - d1[x]) +
                    k.odd[4] * (d8[x] - d0[x]);
    odd_x[x] = u;
    odd_y[x] = v;
    energy[x] = even[x] * even[x] + u * u + v * v;
  }
}

// Both neighbours are loaded before one is chosen, and verdicts are as wide as pixels: compilers vectorise this form.
bool find_maxima(const MaximaRows& rows, int x, float min_energy, float share, std::int32_t* ACCRETE_RESTRICT keep) {
  const float *here = rows.here + x, *above = rows.above + x, *below = rows.below + x, *ox = rows.odd_x + x,
              *oy = rows.odd_y + x, *rival = rows.rival + x;
  std::int32_t any = 0;
  for (int i = 0; i < kChunk; ++i) {
    const float e = here[i], left = here[i - 1], right = here[i + 1], up = above[i], down = below[i];
    // On the ridge of a line both odd parts vanish: there the pair of neighbours that is lower lies across it.
    const float xx = ox[i] * ox[i], yy = oy[i] * oy[i];
    const bool along_x = (xx > yy) | ((xx == yy) & (left + right <= up + down));
    const float p = along_x ? left : up, q = along_x ? right : down;
    const auto maximum = static_cast<std::int32_t>((e > min_energy) & (e > p) & (e >= q) & (rival[i] * share <= e));
    keep[i] = maximum;
    any |= maximum;
  }
  return any != 0;
}

}  // namespace accrete::extract::inline ACCRETE_ISA
