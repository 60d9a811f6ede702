// What the two cameras should see of 3D-primitives, and what an uncertain motion does to them. Edges stand still in the
// map, so the prediction of a state by an exact motion is the identity (docs/math/prediction.md).
#pragma once

#include <cstdint>
#include <span>

#include "accrete/geometry.h"
#include "accrete/motion.h"
#include "accrete/primitive.h"
#include "math/aligned.h"
#include "math/isa.h"

namespace accrete {

// The expected line elements in the aligned images (px, unit directions), and how uncertain the state makes them.
struct PredictedObservation {
  float x_l = 0, y_l = 0, c_l = 1, s_l = 0;
  float x_r = 0, y_r = 0, c_r = 1, s_r = 0;
  float depth_m = 0;
  // Packed upper 4 x 4 of (n_l, theta_l, n_r, theta_r): px across the edge and radians, at slide zero; without the
  // noise of an observation. Positive semi-definite and finite when valid.
  float covariance[10] = {};
  bool valid = false;  // false: behind the cameras or not finite; the other members are then unspecified but finite
};

// Of the instruction set that this file is compiled for; a step takes those of the best one from kernels/kernels.h.
inline namespace ACCRETE_ISA {

// out[i] belongs to primitive slots[i] = 16 * block + lane. The covariance is that of the residual of METHOD 5.2 (A):
// each sigma point's line against the predicted point and direction, so it contains the correlation of both cameras.
// Preconditions: out.size() == slots.size(); slots inside the blocks. Slots may repeat.
void predict_observations(std::span<const GeometryBlock> blocks, std::span<const std::uint32_t> slots,
                          const AlignedPose& pose, const AlignedOptics& optics, std::span<PredictedObservation> out);

// The frame of the map moves, and this motion is exact: p_new = T p_old, on all lanes of all blocks, in closed form.
// The filter itself keeps its states in the frame where the edges stand still and does not need it.
void predict_states(std::span<GeometryBlock> blocks, const Transform<Map, Map>& T_new_old);

// Process noise of an incremental motion (odometry) on all lanes of all blocks: P += D G Q Gt Dt (METHOD 4.1), in
// closed form. `T_m_l` is the pose of the left camera in the map at the new frame; `increment` the covariance of the
// relative motion in that camera's frame. A lane whose result would not be finite keeps its covariance.
void add_incremental_motion_noise(std::span<GeometryBlock> blocks, const Transform<Map, Left>& T_m_l,
                                  const PoseCovariance& increment);

}  // namespace ACCRETE_ISA
}  // namespace accrete
