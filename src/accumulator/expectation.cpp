// Pipeline::predict: which primitives should be seen in this frame, where, and how surely.
#include <algorithm>
#include <cmath>

#include "accumulator/pipeline.h"
#include "existence/evidence.h"
#include "filter/view_change.h"

namespace accrete {
namespace {

// Hidden for association and evidence: at most one look in fifty would find it.
constexpr float kHardlyVisible = 0.02F;

// Matches after which a confirmed primitive is no longer on probation: twice what confirmation needs.
constexpr std::uint32_t kEstablished = 6;

}  // namespace

void Pipeline::predict(const Motion& motion, StepReport& report) {
  const Mat3 R = aligned_.R_a_l * to_matrix(motion.T_l_m.rotation);
  const Vec3 t = aligned_.R_a_l * motion.T_l_m.translation;
  // Any finite motion: what float cannot hold is beyond everything that is seen, at any distance.
  const auto to_float = [](double x) { return static_cast<float>(std::clamp(x, -1e30, 1e30)); };
  for (std::size_t i = 0; i < 9; ++i) pose_.R[i] = static_cast<float>(R[i]);
  for (std::size_t i = 0; i < 3; ++i) pose_.t[i] = to_float(t[i]);
  const Vec3 centre = motion.T_l_m.inverse().translation;
  // The right eye stands a baseline along the x axis of the aligned frame, which is the first row of R in the map.
  for (std::size_t i = 0; i < 3; ++i) {
    centres_[0][i] = to_float(centre[i]);
    centres_[1][i] = to_float(centre[i] + static_cast<double>(optics_.baseline_m) * R[i]);
  }

  if (motion.error == PoseError::kIncremental && has_last_)
    kernels_.add_incremental_motion_noise(w_.geometry, motion.T_l_m.inverse(), motion.covariance);

  live_count_ = 0;
  for (std::uint32_t i = 0; i < w_.tracks.size(); ++i)
    if (w_.tracks[i].state != State::kFree) w_.live[live_count_++] = i;
  kernels_.predict_observations(w_.geometry, w_.live.first(live_count_), pose_, optics_,
                                w_.predicted.first(live_count_));

  expected_count_ = 0;
  for (std::size_t i = 0; i < live_count_; ++i) expect(i, motion, report);
  report.predicted_visible = static_cast<std::uint32_t>(expected_count_);
}

void Pipeline::expect(std::size_t live_index, const Motion& motion, StepReport& report) {
  const std::uint32_t slot = w_.live[live_index];
  const PredictedObservation& p = w_.predicted[live_index];
  Track& track = w_.tracks[slot];
  const auto hide = [&] {
    if (track.state == State::kConfirmed) track.state = State::kPreserved;
  };
  const Geometry g = load(w_.geometry[slot / kBlockLanes], slot % kBlockLanes);
  if (!p.valid) {
    const float* z = &pose_.R[6];
    const float depth = z[0] * g.position[0] + z[1] * g.position[1] + z[2] * g.position[2] + pose_.t[2];
    ++(depth > kMinDepth_m ? report.predicted_degenerate : report.predicted_behind);
    return hide();
  }

  // Pose error that is bounded is noise of the measurement, not of the state (METHOD 4.1, 5.2).
  associate::Expected e;
  e.predicted = p;
  const float px_per_m = optics_.focal_px / p.depth_m;
  const float bias = params_.filter.bias_px;
  e.noise = {bias * bias, 0};
  if (motion.error == PoseError::kAbsolute) {
    const auto& C = motion.covariance;
    const auto tau2 = static_cast<float>((C[0] + C[7] + C[14]) / 3),
               phi2 = static_cast<float>((C[21] + C[28] + C[35]) / 3);
    e.noise.variance_n_px2 += px_per_m * px_per_m * (tau2 + phi2 * dot3(g.position, g.position));
    e.noise.variance_theta += phi2;
  }

  const float sigma_n = std::sqrt(p.covariance[packed_index(4, 0, 0)] + e.noise.variance_n_px2);
  constexpr float kMargin = 2 * extract::kPitch;  // METHOD 7.3
  const float inside =
      std::min(inside_probability(rig_.left, aligned_.R_a_l, aligned_.focal_px, p.x_l, p.y_l, sigma_n, kMargin),
               inside_probability(rig_.right, aligned_.R_a_r, aligned_.focal_px, p.x_r, p.y_r, sigma_n, kMargin));
  if (inside < kHardlyVisible) return hide();

  const auto& q = g.quaternion;
  const Vec3f tangent{1 - 2 * (q[1] * q[1] + q[2] * q[2]), 2 * (q[0] * q[1] + q[3] * q[2]),
                      2 * (q[0] * q[2] - q[3] * q[1])};
  const Vec3f away{2 * (q[0] * q[2] + q[3] * q[1]), 2 * (q[1] * q[2] - q[3] * q[0]),
                   1 - 2 * (q[0] * q[0] + q[1] * q[1])};
  const Vec3f viewer = unit_to(g.position, centres_[0]);
  const float along = dot3(viewer, tangent);
  const float across = std::sqrt(std::max(1 - along * along, 1e-6F));
  const float cos_psi = -dot3(viewer, away) / across;
  const float face = face_probability(track.seen, viewer, cos_psi, std::sqrt(g.covariance[packed_index(6, 3, 3)]));
  // Established primitives remember whether they could be seen. Undecided and newly confirmed ones are held to the
  // geometry, so that a wrong one cannot hide (measured on a rendered box: precision 0.985 instead of 0.973).
  float visible = face;
  if (track.state != State::kTentative && track.observations >= kEstablished) {
    const Vec3f before = unit_to(g.position, last_centres_[0]);
    const float turned = angle_between(viewer, before);
    visible = existence::predicted_visibility(track.visible, face, turned);
  }
  track.visible = visible;
  // A hidden edge stays expected while the geometry allows it to be seen: a miss then costs nothing, and the match that
  // brings it back is not lost.
  if (face * inside < kHardlyVisible) return hide();
  e.visible = std::max(visible, kHardlyVisible) * inside;

  // Foreshortening: a pitch seen from its end is rarely sampled (METHOD 7.3).
  const float shown = track.pitch_m * px_per_m * across / static_cast<float>(extract::kPitch);
  e.detection = params_.existence.detection * std::clamp(shown, 0.2F, 1.0F);

  const AppearanceState a = load(w_.appearance[slot / kBlockLanes], slot % kBlockLanes);
  e.mean = a.mean;
  // What is known is a mean over views: the light may have changed since the last one, and from the middle one.
  const float turned = std::max(angle_between(viewer, track.viewer), std::fabs(turned_about_tangent(g, viewer)));
  const float q_phase = phase_change2(turned), q_colour = colour_change2(turned);
  for (std::size_t k = 0; k < 7; ++k)
    e.variance[k] = a.covariance[packed_index(7, k, k)] + (k == 0 ? q_phase : q_colour);

  w_.expected_slots[expected_count_] = slot;
  w_.expected[expected_count_++] = e;
}

}  // namespace accrete
