// A user's program on the core alone: an accumulator in static storage, and frames of edges that an object carries past
// the cameras. It prints the layout of what crosses the border to the library, and every bit of the model: whatever the
// compiler and the flags of this file are, the same library prints the same. Every number below is exact in binary, and
// so are the sums and products made of them here, whether they are fused or not.
#include <accrete/accumulator.h>
#include <accrete/version.h>

#include <bit>
#include <cstdio>

using namespace accrete;

static Accumulator<SmallLimits> accumulator;

template <class T>
static void print_layout(const char* name) {
  std::printf("%s %zu %zu\n", name, sizeof(T), alignof(T));
}

static StereoRig rig() {
  StereoRig rig;
  for (Camera* c : {&rig.left, &rig.right}) {
    c->width_px = 640;
    c->height_px = 480;
    c->fx_px = c->fy_px = 512;
    c->cx_px = 320;
    c->cy_px = 240;
  }
  rig.T_r_l.translation = {-0.125, 0, 0};
  return rig;
}

// The vertical edge number i of the object at p_o, at a depth of 1 m: a disparity of 64 px.
static Primitive2d edge_at(const Vec3& p_l, int i, float disparity_px) {
  Primitive2d e;
  e.x_px = static_cast<float>(512 * p_l[0] + 320) - disparity_px;
  e.y_px = static_cast<float>(512 * p_l[1] + 240);
  e.theta = 1.5F;
  e.amplitude = 40;
  e.confidence_i1d = 1;
  const float shade = 0.125F * static_cast<float>(i % 8);
  e.appearance = {i % 2 == 0 ? 1.5F : -1.5F, {shade, 0.25F, 0.5F}, {1 - shade, 0.5F, 0.25F}};
  e.sigma_n_px = 0.25F;
  e.sigma_theta = 0.03125F;
  e.sigma_phase = 0.25F;
  e.sigma_colour = 0.03125F;
  return e;
}

static Status show_frame(int k) {
  static Primitive2d left[64], right[64];
  Transform<Left, Object> T_l_o;
  T_l_o.translation = {k * 0.015625, 0, 1};
  for (int i = 0; i < 64; ++i) {
    const Vec3 p_l = T_l_o * Vec3{(i % 8) * 0.0625 - 0.25, (i / 8) * 0.0625 - 0.25, 0};  // NOLINT: whole rows
    left[i] = edge_at(p_l, i, 0);
    right[i] = edge_at(p_l, i, 64);
  }
  const Timestamp t{k * 33'000'000LL + 1};
  Motion motion = Motion::object(t, T_l_o);
  motion.covariance = diagonal_pose_covariance(0.0009765625, 0.0009765625);
  return accumulator.step(ObservedFrame{left, right, t}, motion).status;
}

int main() {
  print_layout<StereoFrame>("StereoFrame");
  print_layout<StereoRig>("StereoRig");
  print_layout<Motion>("Motion");
  print_layout<Params>("Params");
  print_layout<Primitive2d>("Primitive2d");
  print_layout<Primitive3d>("Primitive3d");
  print_layout<GeometryBlock>("GeometryBlock");
  print_layout<AppearanceBlock>("AppearanceBlock");
  print_layout<StepReport>("StepReport");
  print_layout<ModelView>("ModelView");
  print_layout<Accumulator<SmallLimits>>("Accumulator");
  if (accumulator.configure(rig()) != Status::kOk) return 1;
  for (int k = 0; k < 8; ++k)
    if (show_frame(k) != Status::kOk) return 2;
  const ModelView model = accumulator.model();
  for (std::size_t i = 0; i < model.slots(); ++i) {
    if (model.state(i) == State::kFree) continue;
    const Primitive3d p = model.at(i);
    std::printf("%zu %d %08x", i, static_cast<int>(p.state), std::bit_cast<unsigned>(p.existence));
    for (const float x : p.geometry.position) std::printf(" %08x", std::bit_cast<unsigned>(x));
    for (const float x : p.geometry.covariance) std::printf(" %08x", std::bit_cast<unsigned>(x));
    for (const float x : p.appearance.covariance) std::printf(" %08x", std::bit_cast<unsigned>(x));
    std::printf("\n");
  }
  std::printf("accrete %s: %zu primitives\n", kVersion, model.size());
  return model.size() >= 32 ? 0 : 3;
}
