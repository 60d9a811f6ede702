// Every counter of a StepReport by name, for the summary.
#pragma once

#include "accrete/step_report.h"

namespace accrete::cli {

// Calls f(name, value) for the counters of one frame, in the order of the data.
template <class F>
void for_each_counter(const StepReport& r, F&& f) {
  f("left_primitives", r.left.primitives);
  f("left_refused_fill", r.left.refused_fill);
  f("left_refused_dimension", r.left.refused_dimension);
  f("left_refused_capacity", r.left.refused_capacity);
  f("left_refused_distortion", r.left.refused_distortion);
  f("right_primitives", r.right.primitives);
  f("right_refused_fill", r.right.refused_fill);
  f("right_refused_dimension", r.right.refused_dimension);
  f("right_refused_capacity", r.right.refused_capacity);
  f("right_refused_distortion", r.right.refused_distortion);
  f("stereo_matches", r.stereo_matches);
  f("stereo_ambiguous", r.stereo_ambiguous);
  f("stereo_refused_epipolar", r.stereo_refused_epipolar);
  f("stereo_refused_capacity", r.stereo_refused_capacity);
  f("predicted_visible", r.predicted_visible);
  f("predicted_behind", r.predicted_behind);
  f("predicted_degenerate", r.predicted_degenerate);
  f("matched_stereo", r.matched_stereo);
  f("matched_mono", r.matched_mono);
  f("missed", r.missed);
  f("ambiguous", r.ambiguous);
  f("starved", r.starved);
  f("updated", r.updated);
  f("not_novel", r.not_novel);
  f("not_positive_definite", r.not_positive_definite);
  f("update_behind", r.update_behind);
  f("roll_refused", r.roll_refused);
  f("appearance_refused", r.appearance_refused);
  f("born", r.born);
  f("birth_refused_degenerate", r.birth_refused_degenerate);
  f("birth_refused_behind", r.birth_refused_behind);
  f("birth_refused_range", r.birth_refused_range);
  f("birth_refused_excluded", r.birth_refused_excluded);
  f("birth_refused_capacity", r.birth_refused_capacity);
  f("newly_confirmed", r.newly_confirmed);
  f("deleted_existence", r.deleted_existence);
  f("deleted_undecided", r.deleted_undecided);
  f("deleted_background", r.deleted_background);
  f("merged", r.merged);
  f("merge_refused", r.merge_refused);
  f("evicted", r.evicted);
}

// The three that are a state and not an event: they are not summed up.
template <class F>
void for_each_level(const StepReport& r, F&& f) {
  f("tentative", r.tentative);
  f("confirmed", r.confirmed);
  f("preserved", r.preserved);
}

}  // namespace accrete::cli
