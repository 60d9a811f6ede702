// A painted poster in front of a wall, rendered for both eyes with exact poses: enough of a world for the whole
// pipeline.
#pragma once

#include <memory>

#include "accrete/accumulator.h"
#include "core/rig.h"

namespace accrete::test {

struct PosterLimits {
  static constexpr std::size_t kMaxImageWidth = 320;
  static constexpr std::size_t kMaxImageHeight = 240;
  static constexpr std::size_t kMaxPrimitives2d = 1024;
  static constexpr std::size_t kMaxPrimitives3d = 2048;
  static constexpr std::size_t kMaxStereoMatches = 2048;
};

class Poster {
 public:
  static constexpr double kWidth = 0.30, kHeight = 0.24;  // m, around the origin of the map, in its plane z = 0
  static constexpr int kFields = 4;                       // rectangles along each side

  explicit Poster(std::uint64_t seed = 1) : rig(false, 320, 240) {
    Dice dice(seed);
    for (auto& field : fields_)
      field = {dice.uniform(0.3, 0.7),   dice.uniform(0.3, 0.7), dice.uniform(0.25, 0.45),
               dice.uniform(0.25, 0.45), colour(dice),           colour(dice)};
  }

  Rig rig;
  bool occluded = false;  // a bar that stands still in front of the left half
  bool black = false;

  // Turned to and fro by up to 25 degrees about two axes, 0.9 m in front of the cameras.
  [[nodiscard]] static Transform<Left, Map> pose(int frame) {
    const double t = 0.12 * frame;
    const double a = 0.44 * std::sin(t), b = 0.30 * std::sin(1.7 * t + 0.4);
    const Quaternion q = Quaternion{0, std::sin(a / 2), 0, std::cos(a / 2)} *
                         Quaternion{std::sin(b / 2), 0, 0, std::cos(b / 2)} *
                         Quaternion{0, 0, std::sin(0.1), std::cos(0.1)};
    return {q, {0.045 + 0.01 * std::sin(2 * t), 0.01 * std::cos(t) - 0.01, 0.9}};
  }

  // Both images at the pose; they live until the next call.
  StereoFrame render(int frame) { return render(pose(frame), frame); }
  StereoFrame render(const Transform<Left, Map>& T_l_m, int frame) {
    for (int eye = 0; eye < 2; ++eye) images_[eye] = shoot(T_l_m, eye, static_cast<std::uint64_t>(2 * frame + eye));
    return frame_of(images_[0], images_[1], frame);
  }
  [[nodiscard]] static StereoFrame frame_of(const Picture& left, const Picture& right, int frame) {
    StereoFrame f;
    f.left = left.view();
    f.right = right.view();
    f.t_left = f.t_right = time_of(frame);
    f.sequence = static_cast<std::uint64_t>(frame);
    return f;
  }
  [[nodiscard]] static Timestamp time_of(int frame) { return {1'000'000'000LL + 33'000'000LL * frame}; }
  [[nodiscard]] static Motion motion(int frame) {
    Motion m = Motion::object(time_of(frame), retag<Left, Object>(pose(frame)));
    m.covariance = diagonal_pose_covariance(1e-4, 1e-4);
    return m;
  }

 private:
  struct Field {
    double x, y, w, h;
    Rgb inside, outside;  // encoded, 0 .. 1
  };
  static Rgb colour(Dice& dice) { return {dice.uniform(0.1, 0.95), dice.uniform(0.1, 0.95), dice.uniform(0.1, 0.95)}; }

  // `ray` in the left camera's frame, `d` the same in the map's.
  [[nodiscard]] Rgb at(const Vec3& eye, const Vec3& ray, const Vec3& d, const Vec3& eye_in_left) const {
    if (occluded && ray[0] * 0.6 + eye_in_left[0] < 0.03) return {0.5, 0.5, 0.5};  // 0.6 m away
    const double s = -eye[2] / d[2];
    const double u = (eye[0] + s * d[0]) / kWidth + 0.5, v = (eye[1] + s * d[1]) / kHeight + 0.5;
    if (s > 0 && u >= 0 && u < 1 && v >= 0 && v < 1) {
      const int i = static_cast<int>(u * kFields), j = static_cast<int>(v * kFields);
      const Field& f = fields_[static_cast<std::size_t>(j * kFields + i)];
      const double fu = u * kFields - i, fv = v * kFields - j;
      const bool in = std::fabs(fu - f.x) < f.w / 2 && std::fabs(fv - f.y) < f.h / 2;
      return in ? f.inside : f.outside;
    }
    // The wall, 2 m away: bars that stand still.
    const double x = eye_in_left[0] + 2 * ray[0], y = eye_in_left[1] + 2 * ray[1];
    return std::fmod(std::floor((x + 0.3 * y + 10) / 0.09), 2) == 0 ? Rgb{0.75, 0.7, 0.6} : Rgb{0.35, 0.4, 0.45};
  }
  [[nodiscard]] Picture shoot(const Transform<Left, Map>& T_l_m, int eye, std::uint64_t seed) const {
    const Camera& c = eye == 0 ? rig.rig.left : rig.rig.right;
    if (black) return paint(c.width_px, c.height_px, PixelFormat::kRgb8, [](double, double) { return Rgb{}; });
    const auto T_m_l = T_l_m.inverse();
    const Vec3 eye_in_left = eye == 0 ? Vec3{} : rig.rig.T_r_l.inverse().translation;  // the eyes are parallel
    const Vec3 eye_in_map = T_m_l * eye_in_left;
    const Mat3 R_m_l = to_matrix(T_m_l.rotation);
    return paint(
        c.width_px, c.height_px, PixelFormat::kRgb8,
        [&](double x, double y) {
          Rgb light{};  // a pixel integrates light, which is about the square of what is encoded
          for (int k = 0; k < 4; ++k) {
            const Vec3 ray = {(x + (k % 2) * 0.5 - 0.25 - c.cx_px) / c.fx_px,
                              (y + (k / 2) * 0.5 - 0.25 - c.cy_px) / c.fy_px, 1};
            const Rgb v = at(eye_in_map, ray, R_m_l * ray, eye_in_left);
            for (std::size_t i = 0; i < 3; ++i) light[i] += v[i] * v[i] / 4;
          }
          for (double& v : light) v = 255 * std::sqrt(v);
          return light;
        },
        1.5, seed + 1);
  }

  std::array<Field, kFields * kFields> fields_;
  Picture images_[2];
};

// Every slot of a model, comparable.
inline std::vector<Primitive3d> all_slots(const ModelView& model) {
  std::vector<Primitive3d> out(model.slots());
  for (std::size_t i = 0; i < out.size(); ++i)
    if (model.state(i) != State::kFree) out[i] = model.at(i);
  return out;
}
inline bool same(const Primitive3d& a, const Primitive3d& b, bool with_id = true) {
  return (!with_id || a.id == b.id) && a.state == b.state && a.existence == b.existence &&
         a.geometry.position == b.geometry.position && a.geometry.quaternion == b.geometry.quaternion &&
         a.geometry.covariance == b.geometry.covariance && a.appearance.mean.phase == b.appearance.mean.phase &&
         a.appearance.mean.left == b.appearance.mean.left && a.appearance.mean.right == b.appearance.mean.right &&
         a.appearance.covariance == b.appearance.covariance && a.observations == b.observations &&
         a.misfit == b.misfit && a.first_frame == b.first_frame && a.last_frame == b.last_frame;
}
inline ::testing::AssertionResult same(const std::vector<Primitive3d>& a, const std::vector<Primitive3d>& b,
                                       bool with_id = true) {
  if (a.size() != b.size()) return ::testing::AssertionFailure() << a.size() << " and " << b.size() << " slots";
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!same(a[i], b[i], with_id)) return ::testing::AssertionFailure() << "slot " << i << " differs";
  return ::testing::AssertionSuccess();
}

}  // namespace accrete::test
