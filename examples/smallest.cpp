// The smallest program: two images and a pose go in, edges in space come out. The images are drawn here: a pale tile,
// 0.4 m wide, that passes two parallel cameras at a distance of 1 m.
#include <accrete/accumulator.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

static accrete::Accumulator<accrete::SmallLimits> accumulator;  // megabytes: all the memory it will ever use
static std::uint8_t left[480][640], right[480][640];

static accrete::ImageView draw(std::uint8_t (&image)[480][640], double centre_px) {
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x) {
      const double inside_px = 100 - std::abs(x - centre_px) - std::abs(y - 240);
      image[y][x] = static_cast<std::uint8_t>(60 + 140 * std::clamp(inside_px + 0.5, 0.0, 1.0));
    }
  return {image[0], 640, 480, 640, accrete::PixelFormat::kGrey8};
}

int main() {
  accrete::StereoRig rig;  // the calibration: 500 px, a baseline of 0.1 m; p_right = T_r_l * p_left
  rig.left.width_px = 640;
  rig.left.height_px = 480;
  rig.left.fx_px = rig.left.fy_px = 500;
  rig.left.cx_px = 320;
  rig.left.cy_px = 240;
  rig.right = rig.left;
  rig.T_r_l.translation = {-0.1, 0, 0};
  if (accumulator.configure(rig) != accrete::Status::kOk) return 1;

  for (int k = 0; k < 12; ++k) {
    accrete::Transform<accrete::Left, accrete::Object> T_l_o;  // where the tile is, seen from the left camera
    T_l_o.translation = {0.02 * k, 0, 1};
    accrete::StereoFrame frame;
    frame.left = draw(left, 320 + 10 * k);
    frame.right = draw(right, 320 + 10 * k - 50);  // the disparity: 500 px * 0.1 m / 1 m
    frame.t_left = frame.t_right = {k * 33'000'000LL};
    if (accumulator.step(frame, accrete::Motion::object(frame.t_left, T_l_o)).status != accrete::Status::kOk) return 1;
  }

  const accrete::ModelView model = accumulator.model();
  for (std::size_t i = 0; i < model.slots(); ++i) {
    if (model.state(i) != accrete::State::kConfirmed) continue;
    const std::array<float, 3> p = model.at(i).geometry.position;
    std::printf("%.4f %.4f %.4f m\n", p[0], p[1], p[2]);
  }
  return model.size() >= 20 ? 0 : 2;
}
