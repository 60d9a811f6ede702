// The limits of the doctor. Measured on the recordings and scenes that are known to be sane (docs/math/rig_checks.md
// has the table): each lies well outside of what any of them shows, and well inside of what the faults do.
#pragma once

#include <cstddef>

namespace accrete::cli {

inline constexpr double kFewestPairs = 6;         // a frame
inline constexpr double kLeastScore = 0.4;        // mean of 1 - (rows / 1.5 px)^2
inline constexpr double kMostRowsPx = 0.75;       // median of |rows|
inline constexpr double kMostOffsetPx = 0.75;     // |median of rows|
inline constexpr double kMostNegative = 0.25;     // share of disparities below -1 px
inline constexpr double kClearlyBetter = 0.15;    // of the score, for a hypothesis to be named
inline constexpr double kBetterLensScore = 0.05;  // by which another lens must be better,
inline constexpr double kBetterLensRows = 0.7;    // and of the row difference that may be left
inline constexpr double kSameScore = 0.03;        // three standard deviations of a score of 1000 pairs

inline constexpr std::size_t kFewestSteps = 3;      // between consecutive frames, for a word about poses
inline constexpr double kMostPoseResidualPx = 1.5;  // median distance of moved points from where they are seen

inline constexpr double kMuchWorsePoses = 0.25;  // residual over motion: what is wrong by less hardly matters
inline constexpr double kPosesExplained = 0.4;   // of the residual, for a reading of the poses to be named

inline constexpr double kLeastRowMotionPx = 1;       // up or down: three times what rows differ by on kitti_grey
inline constexpr std::size_t kFewestLagPoints = 30;  // that move as much
inline constexpr double kMostLagFrames = 0.4;        // that one eye is later
inline constexpr double kLagGain = 0.6;              // of the row differences' mean, for a lag to be believed
inline constexpr double kMostSkew = 0.25;            // of a frame's interval: difference of the two stamps

inline constexpr double kMostGainStops = 0.5;   // |log2| of right over left brightness, median over the recording
inline constexpr double kMostDriftStops = 0.2;  // how much that changes over the recording

}  // namespace accrete::cli
