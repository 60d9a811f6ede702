// One pose from one row of text, whether it stands in a file or arrives on a line.
#pragma once

#include <string>

#include "motion/pose_table.h"
#include "text/parse.h"

namespace accrete::hal {

// Time, position, quaternion, and the upper triangle of the 6 x 6 covariance, row after row (kTum and kEuroc).
inline constexpr std::size_t kCovarianceColumns = 8 + 21;

// Precondition: the row has the columns of `format`. The time of kTum is left alone: a column of them says whether they
// are seconds. `source` stands in messages. Status: kInvalidArgument (a value that is not finite, a rotation that is
// none, a covariance that is none, a time of kEuroc that is no integer).
Outcome read_pose_row(const std::string& source, const Row& row, PoseFormat format, StampedPose& pose);

}  // namespace accrete::hal
