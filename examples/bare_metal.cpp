// The core on a microcontroller: no operating system, no heap, no images. Something else finds the edges in the images
// (a camera with a processor of its own, programmable logic) and hands them over as 2D-primitives.
#include <accrete/accumulator.h>
#include <accrete/contract.h>

struct Limits {  // 0 x 0: no images; 777 KB in all (docs/memory.md)
  static constexpr std::size_t kMaxImageWidth = 0, kMaxImageHeight = 0;
  static constexpr std::size_t kMaxPrimitives2d = 128;
  static constexpr std::size_t kMaxPrimitives3d = 48;
  static constexpr std::size_t kMaxStereoMatches = 256;
};
static accrete::Accumulator<Limits> accumulator;
static accrete::Primitive2d left[16], right[16];

// Instead of the device that finds edges: 16 upright ones on an object at a distance of 1 m, which moves by 2 cm.
static accrete::Primitive2d measured(int i, float x_px) {
  accrete::Primitive2d e;
  e.x_px = x_px;
  e.y_px = 120.0F + 60.0F * static_cast<float>(i / 4);
  e.theta = 1.57F;
  e.amplitude = 40;
  e.confidence_i1d = 1;
  e.appearance.phase = 1.57F;  // bright on the left
  e.appearance.left = {0.8F, 0.1F * static_cast<float>(i % 4), 0.2F};
  e.appearance.right = {0.2F, 0.2F, 0.05F * static_cast<float>(i)};
  e.sigma_n_px = e.sigma_phase = 0.2F;
  e.sigma_theta = e.sigma_colour = 0.03F;
  return e;
}

int main() {
  accrete::set_contract_handler([](const accrete::ContractViolation&) { /* log it, and restart the board */ });
  accrete::StereoRig rig;
  rig.left.width_px = 640;
  rig.left.height_px = 480;
  rig.left.fx_px = rig.left.fy_px = 500;
  rig.left.cx_px = 320;
  rig.left.cy_px = 240;
  rig.right = rig.left;
  rig.T_r_l.translation = {-0.1, 0, 0};
  if (accumulator.configure(rig) != accrete::Status::kOk) return 1;
  for (int k = 0; k < 12; ++k) {
    for (int i = 0; i < 16; ++i) {
      const float x_px = 220.0F + 50.0F * static_cast<float>(i % 4) + 10.0F * static_cast<float>(k);
      left[i] = measured(i, x_px);
      right[i] = measured(i, x_px - 50);  // 500 px * 0.1 m / 1 m
    }
    accrete::Transform<accrete::Left, accrete::Object> T_l_o;
    T_l_o.translation = {0.02 * k, 0, 1};
    const accrete::Timestamp t{k * 33'000'000LL};
    if (accumulator.step({left, right, t}, accrete::Motion::object(t, T_l_o)).status != accrete::Status::kOk) return 2;
  }
  return accumulator.model().size() == 16 ? 0 : 3;
}
