// A simulated object that turns before two cameras: edges, what the cameras would measure of them, and what goes wrong.
// Only additions, multiplications, divisions and square roots of IEEE, and the library's own elementary functions: the
// measurements are the same bits on every machine.
#pragma once

#include <span>

#include "accrete/camera.h"
#include "accrete/motion.h"
#include "accrete/observed_frame.h"

namespace accrete::determinism {

// xorshift64* (Vigna 2016).
class Random {
 public:
  std::uint32_t next() {
    state_ ^= state_ >> 12;
    state_ ^= state_ << 25;
    state_ ^= state_ >> 27;
    return static_cast<std::uint32_t>((state_ * 0x2545f4914f6cdd1dU) >> 32);
  }
  double uniform(double low, double high) { return low + (high - low) * (next() * 0x1p-32); }
  // Of 12 uniform numbers: bounded by 6 sigma, and no logarithm is needed.
  double normal() {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += uniform(0, 1);
    return sum;
  }
  bool chance(double p) { return uniform(0, 1) < p; }

 private:
  std::uint64_t state_ = 0x9e3779b97f4a7c15U;
};

struct Edge {
  Vec3 p{}, tangent{}, normal{};  // object frame, m; unit vectors; the normal points outwards
  Appearance look;
  bool painted = true;  // false: gone, after it was there
};

// One eye's camera has Brown and Conrady's distortion, the other Kannala and Brandt's; both look inwards.
[[nodiscard]] StereoRig rig();

class World {
 public:
  explicit World(std::span<Edge> edges);

  // What is seen `step` steps after the beginning, in the memory given. Every step must be asked for, in order.
  ObservedFrame observe(int step, std::span<Primitive2d> left, std::span<Primitive2d> right);
  // Belongs to the frame observed last.
  [[nodiscard]] const Motion& motion() const { return motion_; }

 private:
  void place(Edge& edge);
  void turn(int step);
  void repaint(int step);
  bool see(const Edge& edge, int eye, double along_m, Primitive2d& out);
  void clutter(std::span<Primitive2d> eye, std::size_t& n, const Camera& camera, int count);

  std::span<Edge> edges_;
  Random random_;
  StereoRig rig_;
  Quaternion attitude_;
  Vec3 position_{0, 0, 0.8};
  Motion motion_;
};

}  // namespace accrete::determinism
