// The unscented update of pose by what one or two cameras see, the roll pseudo-measurement, and the Kalman update of
// appearance. Equations: docs/math/filter.md. All run on lanes and touch only the slots that they are given.
#pragma once

#include <cstdint>
#include <span>

#include "accrete/primitive.h"
#include "math/aligned.h"
#include "math/isa.h"

namespace accrete {

// Everything but kUpdated leaves the primitive unchanged, bit for bit.
enum class UpdateOutcome : std::uint8_t {
  kUpdated,
  kNotPositiveDefinite,  // the state or the result is not a finite, positive definite Gaussian
  kBehind,               // behind the cameras, or its line passes through a centre of projection
};

enum class Eye : std::uint8_t { kLeft, kRight };

// Of the instruction set that this file is compiled for; a step takes those of the best one from kernels/kernels.h.
inline namespace ACCRETE_ISA {

// Common to all functions: slots[i] = 16 * block + lane belongs to the i-th element of every other span, all spans have
// the same size, slots are inside the blocks and do not repeat. Observations: aligned images, px, radians; sigmas are
// positive, already inflated by the pose error (METHOD 5.2).

// Four residuals: distance and sine of the angle to each sigma point's own line, left and right. The observed direction
// must already be oriented like the predicted one (reversed(), primitive.h). Positions along the edge do not enter.
// slide_variance_cap: m^2 per slot, an upper bound of the variance along the tangent, or empty.
void update_stereo(std::span<GeometryBlock> blocks, std::span<const std::uint32_t> slots,
                   std::span<const LineElement> left, std::span<const LineElement> right, const AlignedPose& pose,
                   const AlignedOptics& optics, std::span<UpdateOutcome> outcomes,
                   std::span<const float> slide_variance_cap = {});

// The same with what one camera sees: two residuals. eyes[i] says which camera.
void update_mono(std::span<GeometryBlock> blocks, std::span<const std::uint32_t> slots,
                 std::span<const LineElement> observed, std::span<const Eye> eyes, const AlignedPose& pose,
                 const AlignedOptics& optics, std::span<UpdateOutcome> outcomes,
                 std::span<const float> slide_variance_cap = {});

// By primitives that were reconstructed from one pair each (METHOD 5.2 B): position and rotation with their covariance,
// in closed form. observed[i / 16], lane i % 16, belongs to slots[i], describes the edge in the state's sense
// (reversed(), primitive.h), and its errors are in its own frame. For data that has no images; a pair of images says
// more than what was reconstructed from it (docs/math/filter.md).
void update_reconstructed(std::span<GeometryBlock> blocks, std::span<const std::uint32_t> slots,
                          std::span<const GeometryBlock> observed, std::span<UpdateOutcome> outcomes);

// Scalar pseudo-measurement of the roll about the tangent (METHOD 3.2): local z is turned towards the current line of
// sight (from the middle of the cameras to the point), as far as it is normal to the tangent. Only the roll is
// corrected: a convention must not move what was measured. Apply it after matches from a new view, sigma_roll = 50
// degrees.
void update_roll(std::span<GeometryBlock> blocks, std::span<const std::uint32_t> slots, const AlignedPose& pose,
                 const AlignedOptics& optics, float sigma_roll, std::span<UpdateOutcome> outcomes);

// Full 7 x 7 linear Kalman update; the innovation of the phase is wrapped. `observed` is already in the primitive's
// sense (reversed() and the seen-from-behind swap are the caller's). The variances of the process noise, q_phase
// (rad^2) and q_colour, are added first. On failure nothing is stored, the process noise neither.
void update_appearance(std::span<AppearanceBlock> blocks, std::span<const std::uint32_t> slots,
                       std::span<const Appearance> observed, std::span<const float> sigma_phase,
                       std::span<const float> sigma_left, std::span<const float> sigma_right,
                       std::span<const float> q_phase, std::span<const float> q_colour,
                       std::span<UpdateOutcome> outcomes);

}  // namespace ACCRETE_ISA
}  // namespace accrete
