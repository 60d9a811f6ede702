#include "cli/bench/pool.h"

#include <algorithm>
#include <cmath>

#include "associate/candidates.h"
#include "kernels/kernels.h"

namespace accrete::cli {
namespace {

constexpr double kDegree = 0.017453292519943295;

// PCG-XSH-RR 64/32 (O'Neill 2014), and from it uniform and normal numbers (Box and Muller).
class Dice {
 public:
  double uniform(double low, double high) { return low + (high - low) * next() * 0x1p-32; }
  double normal() {
    const double r = std::sqrt(-2 * std::log((next() + 1.0) * 0x1p-32));
    return r * std::cos(uniform(0, 2 * 3.14159265358979323846));
  }
  std::uint32_t next() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005ULL + 1442695040888963407ULL;
    const auto shifted = static_cast<std::uint32_t>(((old >> 18U) ^ old) >> 27U);
    const auto turn = static_cast<std::uint32_t>(old >> 59U);
    return (shifted >> turn) | (shifted << ((32U - turn) % 32U));
  }

 private:
  std::uint64_t state_ = 0x853C49E6748FEA9BULL;
};

Quaternion turn(Vec3 axis, double angle) {
  const double s = std::sin(angle / 2) / norm(axis);
  return {axis[0] * s, axis[1] * s, axis[2] * s, std::cos(angle / 2)};
}

// About a point 0.7 m before the cameras, there and back: 2 degrees a frame.
Transform<Left, Map> pose_of(std::size_t frame) {
  const double angle = 2 * kDegree * static_cast<double>(frame < 4 ? frame : 8 - frame);
  const Vec3 centre{0, 0, 0.7};
  const Quaternion q = turn({0.3, 1, 0.2}, angle);
  return {q, centre - to_matrix(q) * centre};
}

struct Edge {
  Vec3 p;
  Quaternion q;
};

LineElement observe(const Edge& x, const Transform<Left, Map>& pose, const AlignedOptics& optics, double offset,
                    Dice& dice) {
  const Vec3 p = pose * x.p - Vec3{offset, 0, 0};
  const Mat3 R = to_matrix(pose.rotation) * to_matrix(x.q);
  const double f = double{optics.focal_px}, u = p[0] / p[2], v = p[1] / p[2];
  const double angle = std::atan2(R[3] - v * R[6], R[0] - u * R[6]);
  const double across = 0.3 * dice.normal(), along = dice.uniform(-2, 2), seen = angle + 2 * kDegree * dice.normal();
  LineElement e;
  e.x_px = static_cast<float>(f * u + along * std::cos(angle) - across * std::sin(angle));
  e.y_px = static_cast<float>(f * v + along * std::sin(angle) + across * std::cos(angle));
  e.c = static_cast<float>(std::cos(seen));
  e.s = static_cast<float>(std::sin(seen));
  e.sigma_n_px = 0.3F;
  e.sigma_theta = static_cast<float>(2 * kDegree);
  return e;
}

// An edge in both images, at 45 degrees or more to the epipolar line, turned by up to 30 degrees out of the image.
Edge random_edge(Dice& dice) {
  const double z = dice.uniform(0.6, 0.8);
  const double tilt = dice.uniform(45, 135) * kDegree, slant = dice.uniform(-30, 30) * kDegree;
  return {{dice.uniform(-0.12, 0.2), dice.uniform(-0.15, 0.15), z}, turn({0, 0, 1}, tilt) * turn({0, 1, 0}, slant)};
}

}  // namespace

BenchPool::BenchPool(std::size_t n)
    : size(n),
      eyes(n),
      sigma_phase(n, 0.35F),
      sigma_colour(n, 0.05F),
      q_phase(n, 4e-4F),
      q_colour(n, 1e-6F),
      predicted(n),
      outcomes(n),
      born_geometry_((n + kBlockLanes - 1) / kBlockLanes),
      born_appearance_(born_geometry_.size()) {
  reconstructed.resize(born_geometry_.size());
  Dice dice;
  // A block's unused lanes hold a state like any other.
  Geometry rest;
  for (std::size_t k = 0; k < 6; ++k) rest.covariance[packed_index(6, k, k)] = 1e-4F;
  AppearanceState plain;
  for (std::size_t k = 0; k < 7; ++k) plain.covariance[packed_index(7, k, k)] = 1e-2F;
  for (std::size_t b = 0; b < born_geometry_.size() * kBlockLanes; ++b) {
    store(rest, born_geometry_[b / kBlockLanes], b % kBlockLanes);
    store(rest, reconstructed[b / kBlockLanes], b % kBlockLanes);
    store(plain, born_appearance_[b / kBlockLanes], b % kBlockLanes);
  }
  for (std::size_t f = 0; f < kFrames; ++f) {
    const Transform<Left, Map> T = pose_of(f);
    frames[f].step = retag<Map, Map>(T * pose_of((f + kFrames - 1) % kFrames).inverse());
    const Mat3 R = to_matrix(T.rotation);
    for (std::size_t i = 0; i < 9; ++i) frames[f].pose.R[i] = static_cast<float>(R[i]);
    for (std::size_t i = 0; i < 3; ++i) frames[f].pose.t[i] = static_cast<float>(T.translation[i]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Edge truth = random_edge(dice);
    Geometry g;
    const double sigma[6] = {0.002, 0.002, 0.01, 50 * kDegree, 0.1, 0.1};
    for (std::size_t k = 0; k < 6; ++k) g.covariance[packed_index(6, k, k)] = static_cast<float>(sigma[k] * sigma[k]);
    const Quaternion q = truth.q * turn({0, 0.1 * dice.normal(), 0.1 * dice.normal() + 1e-9}, 0.1);
    g.quaternion = {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z), static_cast<float>(q.w)};
    const Mat3 own = to_matrix(q);
    const auto place = [&] {  // errors in the own frame, as the covariance has them
      const Vec3 p = truth.p + own * Vec3{sigma[0] * dice.normal(), sigma[1] * dice.normal(), sigma[2] * dice.normal()};
      for (std::size_t k = 0; k < 3; ++k) g.position[k] = static_cast<float>(p[k]);
    };
    place();
    store(g, born_geometry_[i / kBlockLanes], i % kBlockLanes);

    place();
    store(g, reconstructed[i / kBlockLanes], i % kBlockLanes);

    Appearance a;
    a.phase = static_cast<float>(dice.uniform(-3, 3));
    for (auto* side : {&a.left, &a.right})
      for (float& c : *side) c = static_cast<float>(dice.uniform(0, 1));
    AppearanceState s;
    s.mean = a;
    for (std::size_t k = 0; k < 7; ++k) s.covariance[packed_index(7, k, k)] = k == 0 ? 0.12F : 2.5e-3F;
    store(s, born_appearance_[i / kBlockLanes], i % kBlockLanes);

    for (std::size_t f = 0; f < kFrames; ++f) {
      frames[f].left.push_back(observe(truth, pose_of(f), optics, 0, dice));
      frames[f].right.push_back(observe(truth, pose_of(f), optics, double{optics.baseline_m}, dice));
      Appearance look = a;
      look.phase += static_cast<float>(0.1 * dice.normal());
      for (auto* side : {&look.left, &look.right})
        for (float& c : *side) c += static_cast<float>(0.02 * dice.normal());
      frames[f].looks.push_back(look);
    }
    eyes[i] = i % 2 == 0 ? Eye::kLeft : Eye::kRight;
    slots.push_back(static_cast<std::uint32_t>(i));
  }
  scattered = slots;
  for (std::size_t i = n; i > 1; --i) std::swap(scattered[i - 1], scattered[dice.next() % i]);
  prepare_gate();
  restore();
}

void BenchPool::prepare_gate() {
  for (Frame& f : frames)
    for (std::size_t i = 0; i < size; ++i) {
      Primitive2d p;
      p.appearance = f.looks[i];
      p.sigma_phase = sigma_phase[i];
      p.sigma_colour = sigma_colour[i];
      p.aligned = f.left[i];
      f.left_image.push_back(p);
      p.aligned = f.right[i];
      f.right_image.push_back(p);
    }
  std::vector<std::uint32_t> begin(associate::Grid::kCells + 1);
  std::vector<std::uint16_t> order(size);
  for (int eye = 0; eye < 2; ++eye) {
    const std::vector<Primitive2d>& image = eye == 0 ? frames[0].left_image : frames[0].right_image;
    associate::Grid grid{begin, order};
    grid.build(image);
    density_[eye].resize(size);
    clutter_[eye].density = density_[eye];
    clutter_[eye].measure(image, grid, 2 * associate::kSlideGate);
  }
  kernels(InstructionSet::kBaseline).predict_observations(born_geometry_, slots, frames[0].pose, optics, predicted);
  for (std::size_t i = 0; i < size; ++i) {
    associate::Expected e;
    e.predicted = predicted[i];
    const AppearanceState a = load(born_appearance_[i / kBlockLanes], i % kBlockLanes);
    e.mean = a.mean;
    for (std::size_t k = 0; k < 7; ++k) e.variance[k] = a.covariance[packed_index(7, k, k)];
    e.visible = 0.9F;
    e.detection = 0.83F;           // METHOD 7.5
    e.noise = {0.15F * 0.15F, 0};  // METHOD 1.4: the bias that is considered and not filtered
    born_expected_.push_back(e);
  }
}

void BenchPool::restore() {
  geometry = born_geometry_;
  appearance = born_appearance_;
  expected = born_expected_;
}

}  // namespace accrete::cli
