// One image's primitives with everything that association wants to know about them.
#pragma once

#include <vector>

#include "associate/associate.h"
#include "core/rig.h"

namespace accrete::test {

class SeenEye {
 public:
  explicit SeenEye(std::vector<Primitive2d> primitives)
      : primitives_(std::move(primitives)),
        begin_(associate::Grid::kCells + 1),
        order_(primitives_.size()),
        density_(primitives_.size()) {
    grid_.begin = begin_;
    grid_.order = order_;
    grid_.build(primitives_);
    clutter_.density = density_;
    clutter_.measure(primitives_, grid_, 2 * associate::kSlideGate);
  }
  SeenEye(const SeenEye&) = delete;
  SeenEye& operator=(const SeenEye&) = delete;

  [[nodiscard]] associate::EyeView view() const { return {primitives_, &grid_, &clutter_}; }
  [[nodiscard]] const associate::Clutter& clutter() const { return clutter_; }
  [[nodiscard]] const std::vector<Primitive2d>& primitives() const { return primitives_; }

 private:
  std::vector<Primitive2d> primitives_;
  std::vector<std::uint32_t> begin_;
  std::vector<std::uint16_t> order_;
  std::vector<float> density_;
  associate::Grid grid_;
  associate::Clutter clutter_;
};

inline Primitive2d element(double x, double y, double theta, const Appearance& look) {
  Primitive2d p;
  p.aligned = {static_cast<float>(x),
               static_cast<float>(y),
               static_cast<float>(std::cos(theta)),
               static_cast<float>(std::sin(theta)),
               0.2F,
               0.02F};
  p.appearance = look;
  p.sigma_phase = 0.25F;
  p.sigma_colour = 0.02F;
  return p;
}

// What should be seen at these elements, uncertain by sigma_n (px) and sigma_theta (rad) in each eye.
inline associate::Expected expect_at(const LineElement& l, const LineElement& r, const Appearance& look,
                                     double sigma_n = 0.3, double sigma_theta = 0.02) {
  associate::Expected e{};
  PredictedObservation& p = e.predicted;
  p.x_l = l.x_px, p.y_l = l.y_px, p.c_l = l.c, p.s_l = l.s;
  p.x_r = r.x_px, p.y_r = r.y_px, p.c_r = r.c, p.s_r = r.s;
  p.depth_m = 1;
  p.valid = true;
  for (std::size_t i = 0; i < 4; ++i) {
    const double s = i % 2 == 0 ? sigma_n : sigma_theta;
    p.covariance[packed_index(4, i, i)] = static_cast<float>(s * s);
  }
  e.mean = look;
  for (float& v : e.variance) v = 1e-3F;
  e.visible = 0.9F;
  e.detection = 0.83F;
  e.noise = {0.02F, 0};
  return e;
}

// Association with memory of its own.
struct Associator {
  std::vector<associate::Association> out;
  std::vector<std::int32_t> left_owner, right_owner;
  std::vector<associate::Explained> explained;
  associate::GatingRoom room;

  const std::vector<associate::Association>& operator()(std::span<const associate::Expected> expected,
                                                        const SeenEye& left, const SeenEye& right) {
    std::vector<associate::Hypothesis> hypotheses(expected.size() * associate::kPerExpected);
    left_owner.assign(left.primitives().size(), 7);
    right_owner.assign(right.primitives().size(), 7);
    explained.assign(left.primitives().size(), {});
    out.assign(expected.size(), {});
    associate::Scratch scratch{hypotheses, left_owner, right_owner, explained, &room};
    associate::associate(expected, left.view(), right.view(), {associate::gate_both_eyes, associate::gate_one_eye},
                         scratch, out);
    return out;
  }
};

}  // namespace accrete::test
