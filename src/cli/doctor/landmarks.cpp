#include "cli/doctor/landmarks.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace accrete::cli {
namespace {

constexpr int kReach = 14;            // px from a landmark that its descriptor, 8 x 8 samples 3 px apart, needs
constexpr int kApart = 8;             // px between landmarks
constexpr float kLeastSlope2 = 2.0F;  // (grey levels a pixel)^2 in the weaker direction; noise of 2 levels gives 0.2

using Plane = std::vector<float>;

std::size_t place(int x, int y, int w) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(w) + static_cast<std::size_t>(x);
}

// The mean of (2 r + 1) x (2 r + 1) pixels, by sliding sums; nearer than r to the border the window is cut.
Plane box_mean(const Plane& in, int w, int h, int r) {
  Plane half(in.size()), out(in.size());
  const auto count = [r](int i, int n) { return static_cast<float>(std::min(i + r, n - 1) - std::max(i - r, 0) + 1); };
  for (int y = 0; y < h; ++y) {
    const float* row = in.data() + place(0, y, w);
    float sum = 0;
    for (int x = 0; x < std::min(r, w); ++x) sum += row[x];
    for (int x = 0; x < w; ++x) {
      if (x + r < w) sum += row[x + r];
      if (x - r > 0) sum -= row[x - r - 1];
      half[place(x, y, w)] = sum / count(x, w);
    }
  }
  Plane sums(static_cast<std::size_t>(w));  // of a column each, so that the walk goes along the rows
  const auto add = [&](int y, float sign) {
    for (int x = 0; x < w; ++x) sums[static_cast<std::size_t>(x)] += sign * half[place(x, y, w)];
  };
  for (int y = 0; y < std::min(r, h); ++y) add(y, 1);
  for (int y = 0; y < h; ++y) {
    if (y + r < h) add(y + r, 1);
    if (y - r > 0) add(y - r - 1, -1);
    const float n = count(y, h);
    for (int x = 0; x < w; ++x) out[place(x, y, w)] = sums[static_cast<std::size_t>(x)] / n;
  }
  return out;
}

// The smaller eigenvalue of the mean of gradient times gradient, 7 x 7 pixels.
Plane corner_strength(const Plane& smooth, int w, int h) {
  Plane xx(smooth.size()), xy(smooth.size()), yy(smooth.size());
  for (int y = 1; y + 1 < h; ++y)
    for (int x = 1; x + 1 < w; ++x) {
      const std::size_t i = place(x, y, w);
      const float gx = 0.5F * (smooth[i + 1] - smooth[i - 1]);
      const float gy = 0.5F * (smooth[i + static_cast<std::size_t>(w)] - smooth[i - static_cast<std::size_t>(w)]);
      xx[i] = gx * gx;
      xy[i] = gx * gy;
      yy[i] = gy * gy;
    }
  xx = box_mean(xx, w, h, 3);
  xy = box_mean(xy, w, h, 3);
  yy = box_mean(yy, w, h, 3);
  for (std::size_t i = 0; i < xx.size(); ++i) {
    const float mean = 0.5F * (xx[i] + yy[i]), difference = 0.5F * (xx[i] - yy[i]);
    xx[i] = mean - std::sqrt(difference * difference + xy[i] * xy[i]);
  }
  return xx;
}

Landmark describe(const Plane& smooth, int w, int x, int y) {
  Landmark landmark;
  landmark.x = x;
  landmark.y = y;
  std::size_t n = 0;
  for (int j = 0; j < 8; ++j)
    for (int i = 0; i < 8; ++i) {
      const int u = x + (6 * i - 21) / 2, v = y + (6 * j - 21) / 2;
      landmark.descriptor[n++] = smooth[place(u, v, w)];
    }
  float mean = 0, square = 0;
  for (const float d : landmark.descriptor) mean += d / 64;
  for (float& d : landmark.descriptor) {
    d -= mean;
    square += d * d;
  }
  const float scale = 1 / std::sqrt(std::max(square, 1.0F));
  for (float& d : landmark.descriptor) d *= scale;
  landmark.brightness = mean;
  return landmark;
}

float likeness(const Landmark& a, const Landmark& b) {
  float sum = 0;
  for (std::size_t i = 0; i < a.descriptor.size(); ++i) sum += a.descriptor[i] * b.descriptor[i];
  return sum;
}

struct Best {
  std::uint32_t index = 0;
  float first = -1, second = -1;
};

// Cross-correlation of 11 x 11 pixels, mean and contrast removed.
float correlation(const GreyImage& a, int ax, int ay, const GreyImage& b, int bx, int by) {
  float sa = 0, sb = 0, aa = 0, bb = 0, ab = 0;
  for (int v = -5; v <= 5; ++v)
    for (int u = -5; u <= 5; ++u) {
      const auto p = static_cast<float>(a.at(ax + u, ay + v)), q = static_cast<float>(b.at(bx + u, by + v));
      sa += p;
      sb += q;
      aa += p * p;
      bb += q * q;
      ab += p * q;
    }
  constexpr float kN = 121;
  const float va = aa - sa * sa / kN, vb = bb - sb * sb / kN;
  return (ab - sa * sb / kN) / std::sqrt(std::max(va * vb, 1.0F));
}

float peak_of_parabola(float before, float at, float after) {
  const float curvature = before - 2 * at + after;
  return curvature < 0 ? std::clamp(0.5F * (before - after) / curvature, -0.5F, 0.5F) : 0;
}

// The partner's place to a fraction of a pixel; false when the surroundings have no peak of likeness nearby.
bool refine(const GreyImage& a, const Landmark& from, const GreyImage& b, const Landmark& to, Pixel& place) {
  float score[7][7];
  int bx = 0, by = 0;
  for (int v = -3; v <= 3; ++v)
    for (int u = -3; u <= 3; ++u) {
      score[v + 3][u + 3] = correlation(a, from.x, from.y, b, to.x + u, to.y + v);
      if (score[v + 3][u + 3] > score[by + 3][bx + 3]) {
        bx = u;
        by = v;
      }
    }
  if (std::abs(bx) == 3 || std::abs(by) == 3 || score[by + 3][bx + 3] < 0.8F) return false;
  const auto& s = score;
  const int i = bx + 3, j = by + 3;
  place = {to.x + bx + static_cast<double>(peak_of_parabola(s[j][i - 1], s[j][i], s[j][i + 1])),
           to.y + by + static_cast<double>(peak_of_parabola(s[j - 1][i], s[j][i], s[j + 1][i]))};
  return true;
}

}  // namespace

GreyImage to_grey(const ImageView& image) {
  GreyImage grey{image.width_px, image.height_px, {}};
  grey.pixels.reserve(static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px));
  for (int y = 0; y < image.height_px; ++y) {
    const std::uint8_t* row = image.row(y);
    for (int x = 0; x < image.width_px; ++x) {
      if (image.format == PixelFormat::kGrey8) {
        grey.pixels.push_back(row[x]);
      } else {  // the mean of the colours: which is red does not matter here
        grey.pixels.push_back(static_cast<std::uint8_t>((row[3 * x] + row[3 * x + 1] + row[3 * x + 2] + 1) / 3));
      }
    }
  }
  return grey;
}

GreyImage mirrored(const GreyImage& image, bool columns, bool rows) {
  GreyImage out = image;
  std::size_t n = 0;
  for (int y = 0; y < image.height_px; ++y)
    for (int x = 0; x < image.width_px; ++x)
      out.pixels[n++] =
          static_cast<std::uint8_t>(image.at(columns ? image.width_px - 1 - x : x, rows ? image.height_px - 1 - y : y));
  return out;
}

LandmarkImage find_landmarks(GreyImage image, std::size_t most) {
  LandmarkImage out;
  const int w = image.width_px, h = image.height_px;
  out.grey = std::move(image);
  if (w < 2 * kReach + 2 || h < 2 * kReach + 2) return out;
  const Plane raw(out.grey.pixels.begin(), out.grey.pixels.end());
  const Plane smooth = box_mean(raw, w, h, 1);
  const Plane strength = corner_strength(smooth, w, h);
  const auto at = [w](int x, int y) { return place(x, y, w); };
  std::vector<std::size_t> peaks;
  for (int y = kReach; y + kReach < h; ++y)
    for (int x = kReach; x + kReach < w; ++x) {
      const float s = strength[at(x, y)];
      if (s < kLeastSlope2) continue;
      bool peak = true;
      for (int v = -1; v <= 1 && peak; ++v)
        for (int u = -1; u <= 1; ++u)
          if (strength[at(x + u, y + v)] > s) peak = false;
      if (peak) peaks.push_back(at(x, y));
    }
  std::sort(peaks.begin(), peaks.end(), [&](std::size_t a, std::size_t b) {
    return strength[a] != strength[b] ? strength[a] > strength[b] : a < b;
  });
  const Plane description = box_mean(raw, w, h, 2);
  std::vector<char> taken(strength.size(), 0);
  for (const std::size_t p : peaks) {
    if (out.landmarks.size() == most) break;
    if (taken[p] != 0) continue;
    const int x = static_cast<int>(p % static_cast<std::size_t>(w)),
              y = static_cast<int>(p / static_cast<std::size_t>(w));
    for (int v = -kApart; v <= kApart; ++v)
      for (int u = -kApart; u <= kApart; ++u) taken[at(x + u, y + v)] = 1;
    out.landmarks.push_back(describe(description, w, x, y));
  }
  return out;
}

std::vector<Pair> pair_landmarks(const LandmarkImage& a, const LandmarkImage& b) {
  constexpr float kLeast = 0.8F;      // likeness of two views of one spot
  constexpr float kAmbiguous = 0.7F;  // of the distance to the second best
  std::vector<Best> of_a(a.landmarks.size()), of_b(b.landmarks.size());
  const auto offer = [](Best& best, std::size_t index, float score) {
    if (score > best.first) {
      best.second = best.first;
      best.first = score;
      best.index = static_cast<std::uint32_t>(index);
    } else {
      best.second = std::max(best.second, score);
    }
  };
  for (std::size_t i = 0; i < of_a.size(); ++i)
    for (std::size_t j = 0; j < of_b.size(); ++j) {
      const float score = likeness(a.landmarks[i], b.landmarks[j]);
      offer(of_a[i], j, score);
      offer(of_b[j], i, score);
    }
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    const Best& best = of_a[i];
    if (best.first < kLeast || of_b[best.index].index != i) continue;
    const float second = std::max(best.second, of_b[best.index].second);
    if (1 - best.first > kAmbiguous * (1 - second)) continue;
    const Landmark &l = a.landmarks[i], &r = b.landmarks[best.index];
    Pair pair{{static_cast<double>(l.x), static_cast<double>(l.y)},
              {},
              static_cast<std::uint32_t>(i),
              best.index,
              l.brightness,
              r.brightness};
    if (refine(a.grey, l, b.grey, r, pair.b)) pairs.push_back(pair);
  }
  return pairs;
}

}  // namespace accrete::cli
