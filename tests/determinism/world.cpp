#include "determinism/world.h"

#include "base/elementary.h"

namespace accrete::determinism {
namespace {

constexpr double kRadius = 0.2;      // m, of the ball that carries the edges
constexpr double kPitch = 0.0035;    // m: a sampling pitch on it
constexpr double kDetection = 0.85;  // of an edge that is visible, in each eye
constexpr double kSigma = 0.2, kSigmaTheta = 0.02, kSigmaPhase = 0.2, kSigmaColour = 0.02;

Vec3 unit(const Vec3& v) { return (1 / norm(v)) * v; }

Quaternion product_of_unit_length(const Quaternion& a, const Quaternion& b) {
  const Quaternion q = a * b;
  const double k = 1 / std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return {q.x * k, q.y * k, q.z * k, q.w * k};
}

float bounded(double colour) { return static_cast<float>(colour < 0 ? 0 : colour > 1 ? 1 : colour); }

}  // namespace

StereoRig rig() {
  StereoRig rig;
  for (Camera* c : {&rig.left, &rig.right}) {
    c->width_px = 640;
    c->height_px = 480;
    c->fx_px = c->fy_px = 600;
    c->cx_px = 319.5;
    c->cy_px = 239.5;
  }
  rig.left.distortion = Distortion::kBrownConrady;
  rig.left.coefficients = {-0.12, 0.03, 0.0005, -0.0004, 0.001};
  rig.right.distortion = Distortion::kKannalaBrandt;
  rig.right.coefficients = {0.02, -0.01, 0.002, 0};
  rig.right.cx_px += 7;
  // The right camera stands 0.1 m to the right and looks 0.12 rad to the left.
  rig.T_r_l.rotation = {0, sin_of(0.06), 0, cos_of(0.06)};
  rig.T_r_l.translation = -1.0 * (to_matrix(rig.T_r_l.rotation) * Vec3{0.1, 0.002, 0.001});
  return rig;
}

World::World(std::span<Edge> edges) : edges_(edges), rig_(rig()) {
  for (Edge& e : edges_) place(e);
  motion_.covariance = diagonal_pose_covariance(2e-4, 5e-4);
}

void World::place(Edge& edge) {
  do {
    edge.normal = {random_.uniform(-1, 1), random_.uniform(-1, 1), random_.uniform(-1, 1)};
  } while (!(dot(edge.normal, edge.normal) < 1 && dot(edge.normal, edge.normal) > 0.01));
  edge.normal = unit(edge.normal);
  do {
    const Vec3 v{random_.uniform(-1, 1), random_.uniform(-1, 1), random_.uniform(-1, 1)};
    edge.tangent = cross(edge.normal, v);
  } while (!(dot(edge.tangent, edge.tangent) > 0.01));
  edge.tangent = unit(edge.tangent);
  edge.p = kRadius * edge.normal;
  edge.look.phase = static_cast<float>(random_.uniform(-3.1, 3.1));
  for (auto* side : {&edge.look.left, &edge.look.right})
    for (float& c : *side) c = static_cast<float>(random_.uniform(0, 1));
  edge.painted = true;
}

// About an axis that wanders, 0.6 to 1.2 degrees a step; position within a centimetre.
void World::turn(int step) {
  const double a = 0.005 + 0.0025 * random_.uniform(0, 2), b = 0.001 * random_.normal();
  attitude_ = product_of_unit_length(Quaternion{b, a, 0.001 * random_.normal(), 1}, attitude_);
  for (double& v : position_) v += 2e-4 * random_.normal();
  for (std::size_t k = 0; k < 3; ++k) position_[k] += 0.02 * ((k == 2 ? 0.8 : 0) - position_[k]);
  motion_.t = Timestamp{33'000'000 * static_cast<std::int64_t>(step + 1)};
  motion_.T_l_m = {attitude_, position_};
  // A robot's encoders, and for one step in eight odometry, whose errors the states inherit.
  const bool absolute = step % 8 != 5;
  motion_.error = absolute ? PoseError::kAbsolute : PoseError::kIncremental;
  motion_.covariance = absolute ? diagonal_pose_covariance(2e-4, 5e-4) : diagonal_pose_covariance(2e-5, 5e-5);
}

// Now and then edges vanish, and later others are painted in their place: deletions and births long after the
// beginning.
void World::repaint(int step) {
  if (step % 16 != 15) return;
  for (std::size_t k = 0; k < edges_.size() / 100 + 1; ++k) {
    Edge& e = edges_[random_.next() % edges_.size()];
    if (e.painted)
      e.painted = false;
    else
      place(e);
  }
}

bool World::see(const Edge& edge, int eye, double along_m, Primitive2d& out) {
  const Camera& camera = eye == 0 ? rig_.left : rig_.right;
  const auto pixel = [&](double along) {
    const Vec3 l = motion_.T_l_m * (edge.p + along * edge.tangent), c = eye == 0 ? l : rig_.T_r_l * l;
    return project(camera, {c[0] / c[2], c[1] / c[2]});
  };
  const auto m = pixel(along_m), ahead = pixel(along_m + 1e-4);
  if (!m.ok() || !ahead.ok()) return false;
  const double dx = ahead.value().x - m.value().x, dy = ahead.value().y - m.value().y;
  const double k = 1 / std::sqrt(dx * dx + dy * dy), noise = kSigma * random_.normal();
  const double x = m.value().x - noise * dy * k, y = m.value().y + noise * dx * k;
  if (!(x >= 8 && y >= 8 && x <= 631 && y <= 471)) return false;
  out = {};
  out.x_px = static_cast<float>(x);
  out.y_px = static_cast<float>(y);
  out.appearance = edge.look;
  out.appearance.phase = static_cast<float>(out.appearance.phase + kSigmaPhase * random_.normal());
  for (auto* side : {&out.appearance.left, &out.appearance.right})
    for (float& c : *side) c = bounded(c + kSigmaColour * random_.normal());
  constexpr double kHalfTurn = 3.14159265358979;
  double theta = atan2_of(dy, dx) + kSigmaTheta * random_.normal();
  while (theta < 0 || theta >= kHalfTurn) {  // the range of extraction; beyond, it is the other description
    theta += theta < 0 ? kHalfTurn : -kHalfTurn;
    out.appearance = reversed(out.appearance);
  }
  if (out.appearance.phase > 3.1415F) out.appearance.phase -= 6.2831853F;
  if (out.appearance.phase < -3.1415F) out.appearance.phase += 6.2831853F;
  out.theta = static_cast<float>(theta);
  out.amplitude = 30;
  out.confidence_i1d = 0.9F;
  out.sigma_n_px = static_cast<float>(kSigma);
  out.sigma_theta = static_cast<float>(kSigmaTheta);
  out.sigma_phase = static_cast<float>(kSigmaPhase);
  out.sigma_colour = static_cast<float>(kSigmaColour);
  return true;
}

// Chance edges anywhere, different in every frame; and a few that stand still in both images like a background.
void World::clutter(std::span<Primitive2d> eye, std::size_t& n, const Camera& camera, int count) {
  for (int i = 0; i < count && n < eye.size(); ++i) {
    Primitive2d p;
    p.x_px = static_cast<float>(random_.uniform(8, camera.width_px - 9));
    p.y_px = static_cast<float>(random_.uniform(8, camera.height_px - 9));
    p.theta = static_cast<float>(random_.uniform(0, 3.14));
    p.appearance.phase = static_cast<float>(random_.uniform(-3.1, 3.1));
    for (auto* side : {&p.appearance.left, &p.appearance.right})
      for (float& c : *side) c = static_cast<float>(random_.uniform(0, 1));
    p.amplitude = 20;
    p.confidence_i1d = 0.8F;
    p.sigma_n_px = static_cast<float>(kSigma);
    p.sigma_theta = static_cast<float>(kSigmaTheta);
    p.sigma_phase = static_cast<float>(kSigmaPhase);
    p.sigma_colour = static_cast<float>(kSigmaColour);
    eye[n++] = p;
  }
}

ObservedFrame World::observe(int step, std::span<Primitive2d> left, std::span<Primitive2d> right) {
  turn(step);
  repaint(step);
  const Vec3 viewer = motion_.T_l_m.inverse().translation;
  std::size_t n[2] = {0, 0};
  // Something passes between: for 60 of 100 steps it hides a strip of the ball that moves on.
  const double strip = step % 100 < 60 ? -kRadius + 2 * kRadius * (step % 60) / 60 : 1;
  for (const Edge& e : edges_) {
    if (!e.painted) continue;
    const Vec3 to_viewer = unit(viewer - e.p);
    if (dot(to_viewer, e.normal) < 0.35) continue;  // faces away: beyond 70 degrees
    const Vec3 l = motion_.T_l_m * e.p;
    if (l[0] > strip && l[0] < strip + 0.06) continue;
    // One contour is sampled twice at times: duplicates, to be merged.
    const int samples = random_.chance(0.05) ? 2 : 1;
    for (int s = 0; s < samples; ++s)
      for (int eye = 0; eye < 2; ++eye) {
        const std::span<Primitive2d> out = eye == 0 ? left : right;
        const double along = kPitch * random_.uniform(-0.5, 0.5);
        const bool found = random_.chance(kDetection);
        Primitive2d p;
        if (see(e, eye, along, p) && found && n[eye] < out.size()) out[n[eye]++] = p;
      }
  }
  const int count = static_cast<int>(edges_.size() / 40 + 1);
  clutter(left, n[0], rig_.left, count);
  clutter(right, n[1], rig_.right, count);
  // A background that does not move: the same edges of the left image in the right one, 10 px further left.
  Random standing;
  std::swap(standing, random_);
  const std::size_t first = n[0];
  clutter(left, n[0], rig_.left, count);
  std::swap(standing, random_);
  for (std::size_t i = first; i < n[0] && n[1] < right.size(); ++i) {
    Primitive2d p = left[i];
    p.x_px -= 10;
    if (p.x_px > 8) right[n[1]++] = p;
  }
  return {left.first(n[0]), right.first(n[1]), motion_.t};
}

}  // namespace accrete::determinism
