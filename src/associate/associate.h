// Which observation belongs to which predicted primitive: one to one, by geometry and appearance (METHOD 6).
#pragma once

#include <span>

#include "accrete/primitive.h"
#include "associate/clutter.h"
#include "associate/gate.h"
#include "associate/grid.h"
#include "predict/predict.h"

namespace accrete::associate {

inline constexpr std::int32_t kNone = -1;
inline constexpr float kSlideGate = 4.5F;  // px along the edge: three quarters of a pitch (METHOD 5.2)

// A primitive that should be seen now.
struct Expected {
  PredictedObservation predicted;
  Appearance mean;
  float variance[7];  // of appearance, predicted
  float visible;      // P_vis
  float detection;    // p_d of one eye
  Noise noise;
};

enum class AssociateOutcome : std::uint8_t {
  kMissed,     // nothing in its gate
  kStereo,     // both eyes
  kMono,       // one eye
  kAmbiguous,  // two contours fit about equally well: no evidence either way
  kStarved,    // its observation belongs to a neighbour on the same contour: no evidence either way
};

struct Association {
  AssociateOutcome outcome = AssociateOutcome::kMissed;
  std::int32_t left = kNone, right = kNone;
  bool left_reversed = false, right_reversed = false;
  float log_likelihood_ratio = 0;  // IPDA bracket of METHOD 7.2 for both eyes; not clipped
  float d2 = 0;                    // squared geometric innovation of a match: 4 degrees of freedom, 2 of one eye
};

// One image of the pair.
struct EyeView {
  std::span<const Primitive2d> primitives;
  const Grid* grid;
  const Clutter* clutter;
};

struct Hypothesis {
  float gain;  // log likelihood ratio over that of a miss
  float log_likelihood_ratio;
  std::uint32_t expected;
  std::int32_t left, right;
  bool left_reversed, right_reversed;
  float d2;
};

// For every left primitive, up to a few right ones with which it is already explained by some expected primitive,
// matched or not: no births there (METHOD 6.5).
struct Explained {
  static constexpr std::size_t kMax = 6;
  std::array<std::uint16_t, kMax> right;
  std::uint8_t count = 0;
};

struct Scratch {
  std::span<Hypothesis> hypotheses;    // room for kPerExpected per expected primitive
  std::span<std::int32_t> left_owner;  // per left primitive: index of the expected one, or kNone
  std::span<std::int32_t> right_owner;
  std::span<Explained> explained;  // per left primitive
};
inline constexpr std::size_t kPerExpected = 4;

// out.size() == expected.size().
void associate(std::span<const Expected> expected, const EyeView& left, const EyeView& right, Scratch& scratch,
               std::span<Association> out);

}  // namespace accrete::associate
