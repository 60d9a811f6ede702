// What `accrete bench` and bench/filter work on: random edges before a stereo rig that moves through a cycle of eight
// frames, and what it observes of them. Made without a clock and without the standard library's distributions: the same
// on every machine.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "associate/gate_pairs.h"
#include "filter/update.h"
#include "predict/predict.h"

namespace accrete::cli {

struct BenchPool {
  static constexpr std::size_t kFrames = 8;

  struct Frame {
    AlignedPose pose;          // map to the cameras
    Transform<Map, Map> step;  // from the cameras of the frame before to those of this one
    std::vector<LineElement> left, right;
    std::vector<Appearance> looks;
    std::vector<Primitive2d> left_image, right_image;  // the same, as association sees it
  };

  // `n` > 0 primitives as stereo gives birth to them: sigma 2 mm across, 10 mm in depth, 0.1 rad of tilt, 50 degrees of
  // roll. Observations have noise of 0.3 px and 2 degrees and slide along the edge by up to 2 px.
  explicit BenchPool(std::size_t n);

  // Primitives as born, as if nothing had been observed.
  void restore();

  std::size_t size;
  AlignedOptics optics{800, 0.12F};
  AlignedPose here;  // for states that are kept in the frame of the cameras
  std::array<Frame, kFrames> frames;
  std::vector<std::uint32_t> slots;      // 0 .. n - 1
  std::vector<std::uint32_t> scattered;  // the same in random order
  std::vector<Eye> eyes;
  std::vector<float> sigma_phase, sigma_colour, q_phase, q_colour;

  std::vector<GeometryBlock> geometry;
  std::vector<AppearanceBlock> appearance;
  std::vector<GeometryBlock> reconstructed;  // what model B observes: the same in every frame
  std::vector<PredictedObservation> predicted;
  std::vector<UpdateOutcome> outcomes;

  // For the gate: every primitive with its own observations. Chance is measured in the first frame.
  std::vector<associate::Expected> expected;
  associate::PairBatch pairs;
  [[nodiscard]] associate::EyeView view(const Frame& frame, int eye) const {
    return {eye == 0 ? frame.left_image : frame.right_image, nullptr, &clutter_[eye]};
  }

 private:
  void prepare_gate();

  std::vector<GeometryBlock> born_geometry_;
  std::vector<AppearanceBlock> born_appearance_;
  std::vector<associate::Expected> born_expected_;
  associate::Clutter clutter_[2];
  std::vector<float> density_[2];
};

}  // namespace accrete::cli
