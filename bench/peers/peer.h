// Filters as one would write or take them otherwise, on the same primitives as ours: one object for each primitive, 13
// states (position, rotation error, phase, colours), 11 measurements (distance and angle in both images, appearance).
#pragma once

#include <memory>
#include <vector>

#include "cli/bench/pool.h"

namespace accrete::bench {

struct PeerEstimate {
  double position[3], tangent[3];
};

class Peer {
 public:
  virtual ~Peer() = default;
  [[nodiscard]] virtual const char* name() const = 0;
  virtual void restore() = 0;                  // primitives as born
  virtual void frame(std::size_t number) = 0;  // predict, gate and update of all
  [[nodiscard]] virtual PeerEstimate estimate(std::size_t i) const = 0;
  [[nodiscard]] virtual std::size_t bytes() const = 0;  // of one filter, without its heap
};

// The pool must outlive the peer and stay as it was born.
[[nodiscard]] std::unique_ptr<Peer> fixed_eigen_double(const cli::BenchPool& pool);
[[nodiscard]] std::unique_ptr<Peer> fixed_eigen_float(const cli::BenchPool& pool);
// Pose and appearance apart: 6 states by sigma points, 7 by a Kalman filter.
[[nodiscard]] std::unique_ptr<Peer> block_eigen(const cli::BenchPool& pool);
[[nodiscard]] std::unique_ptr<Peer> dynamic_eigen(const cli::BenchPool& pool);
[[nodiscard]] std::unique_ptr<Peer> opencv(const cli::BenchPool& pool);  // null: this build is without OpenCV

}  // namespace accrete::bench
