#include "accumulator/pipeline.h"

#include <cmath>

#include "store/birth.h"
#include "store/merge.h"

namespace accrete {
namespace {

// Duplicates are looked for in every tenth frame (METHOD 6.6).
constexpr std::uint32_t kMergeEvery = 10;

class StageScope {
 public:
  StageScope(const StageObserver& observer, Stage stage) : observer_(observer), stage_(stage) { tell(true); }
  ~StageScope() { tell(false); }
  StageScope(const StageScope&) = delete;
  StageScope& operator=(const StageScope&) = delete;

 private:
  void tell(bool begins) const {
    if (observer_.notify != nullptr) observer_.notify(observer_.context, stage_, begins);
  }
  const StageObserver& observer_;
  Stage stage_;
};

bool fits(const ImageView& image, const Camera& camera) {
  return image.valid() && image.width_px == camera.width_px && image.height_px == camera.height_px;
}

}  // namespace

void Pipeline::bind_store() {
  store_.geometry = w_.geometry;
  store_.appearance = w_.appearance;
  store_.tracks = w_.tracks;
  store_.free_slots = w_.free_slots;
  store_.scratch = w_.slot_scratch;
  store_.clear();
}

Status Pipeline::configure(const StereoRig& rig, const Params& params) {
  if (const Status s = validate(capacities_); s != Status::kOk) return s;
  if (const Status s = validate(rig); s != Status::kOk) return s;
  if (const Status s = validate(params); s != Status::kOk) return s;
  for (const Camera* c : {&rig.left, &rig.right})
    if (capacities_.image_width > 0 && (static_cast<std::size_t>(c->width_px) > capacities_.image_width ||
                                        static_cast<std::size_t>(c->height_px) > capacities_.image_height))
      return Status::kCapacityExceeded;
  rig_ = rig;
  params_ = params;
  aligned_ = align(rig);
  optics_ = {static_cast<float>(aligned_.focal_px), static_cast<float>(aligned_.baseline_m)};
  configured_ = true;
  reset();
  return Status::kOk;
}

void Pipeline::reset() {
  store_.clear();
  frame_ = 0;
  has_last_ = false;
  typical_misfit_ = 1;
  has_previous_[0] = has_previous_[1] = false;
  count_[0] = count_[1] = match_count_ = live_count_ = expected_count_ = 0;
}

Status Pipeline::check(Timestamp t_left, Timestamp t_right, const Motion& motion) const {
  if (!configured_) return Status::kUnavailable;
  if (has_last_ && (t_left <= last_left_ || t_right < last_right_ || motion.t < last_motion_))
    return Status::kInvalidArgument;
  return validate(motion);
}

StepReport Pipeline::step(const StereoFrame& frame, const Motion& motion) {
  StepReport report;
  report.status = check(frame.t_left, frame.t_right, motion);
  if (report.status != Status::kOk) return report;
  if (!fits(frame.left, rig_.left) || !fits(frame.right, rig_.right)) {
    report.status = Status::kInvalidArgument;
    return report;
  }
  if (capacities_.image_width == 0) {
    report.status = Status::kCapacityExceeded;
    return report;
  }
  {
    const StageScope stage(observer_, Stage::kExtract);
    extract(frame, report);
  }
  proceed(frame.t_left, frame.t_right, motion, report);
  return report;
}

void Pipeline::proceed(Timestamp t_left, Timestamp t_right, const Motion& motion, StepReport& report) {
  report.frame = frame_;
  report.motion_covariance_is_default = motion.covariance_is_default;
  {
    const StageScope stage(observer_, Stage::kStereo);
    match(report);
  }
  {
    const StageScope stage(observer_, Stage::kPredict);
    predict(motion, report);
  }
  {
    const StageScope stage(observer_, Stage::kAssociate);
    associate();
  }
  {
    const StageScope stage(observer_, Stage::kExistence);
    judge(report);  // before the filter moves the states that the evidence was measured against
  }
  {
    const StageScope stage(observer_, Stage::kFilter);
    filter(report);
  }
  {
    const StageScope stage(observer_, Stage::kStore);
    renew(report);
  }
  for (const Track& t : w_.tracks) {
    report.tentative += t.state == State::kTentative;
    report.confirmed += t.state == State::kConfirmed;
    report.preserved += t.state == State::kPreserved;
  }
  ++frame_;
  has_last_ = true;
  last_left_ = t_left;
  last_right_ = t_right;
  last_motion_ = motion.t;
  last_centres_ = centres_;
}

void Pipeline::extract(const StereoFrame& frame, StepReport& report) {
  struct Work {
    Pipeline& pipeline;
    const StereoFrame& frame;
    StepReport& report;
  } work{*this, frame, report};
  const auto task = [](void* argument, int eye) {
    const auto& w = *static_cast<Work*>(argument);
    w.pipeline.extract(w.frame, eye, w.report);
  };
  if (runner_.run != nullptr) {
    runner_.run(runner_.context, task, &work);
  } else {
    task(&work, 0);
    task(&work, 1);
  }
}

// Both eyes at once, perhaps: touches what belongs to its eye alone.
void Pipeline::extract(const StereoFrame& frame, int eye, StepReport& report) {
  EyeMemory& m = w_.eye[eye];
  const Camera& camera = eye == 0 ? rig_.left : rig_.right;
  const extract::Alignment alignment{&camera, eye == 0 ? aligned_.R_a_l : aligned_.R_a_r, aligned_.focal_px};
  extract::Scratch scratch{m.rows, m.cells, m.previous, has_previous_[eye]};
  ExtractCounts counts;  // here, because both eyes' in the report share a cache line
  count_[eye] = extract::extract(eye == 0 ? frame.left : frame.right, params_.extract, alignment, kernels_.rows,
                                 scratch, m.primitives, counts);
  (eye == 0 ? report.left : report.right) = counts;
  has_previous_[eye] = true;
}

void Pipeline::match(StepReport& report) {
  stereo::Scratch scratch{{w_.eye[0].row_order, w_.eye[0].row_begin},
                          {w_.eye[1].row_order, w_.eye[1].row_begin},
                          w_.candidates,
                          w_.best_of_right};
  match_count_ = stereo::match(primitives(0), primitives(1), params_.stereo, optics_, rig_.left.width_px, scratch,
                               w_.matches, report);
}

associate::EyeView Pipeline::eye_view(int eye) const { return {primitives(eye), &grid_[eye], &clutter_[eye]}; }

void Pipeline::associate() {
  for (int eye = 0; eye < 2; ++eye) {
    const EyeMemory& m = w_.eye[eye];
    grid_[eye].begin = m.grid_begin;
    grid_[eye].order = m.grid_order;
    grid_[eye].build(primitives(eye));
    clutter_[eye].density = m.density;
    clutter_[eye].measure(primitives(eye), grid_[eye], 2 * associate::kSlideGate);
  }
  associate::Scratch scratch{w_.hypotheses, w_.eye[0].owner, w_.eye[1].owner, w_.explained, w_.gating.data()};
  associate::associate(w_.expected.first(expected_count_), eye_view(0), eye_view(1), kernels_.gate, scratch,
                       w_.associations.first(expected_count_));
}

void Pipeline::renew(StepReport& report) {
  const BirthInput births{primitives(0), primitives(1), matches(), w_.eye[0].owner, w_.eye[1].owner,
                          w_.explained,  pose_,         optics_,   frame_};
  if (frame_ % kMergeEvery == kMergeEvery - 1)
    merge_duplicates(w_.expected_slots.first(expected_count_), w_.expected.first(expected_count_), w_.eye[0].grid_begin,
                     w_.live, params_.filter.bias_px, optics_.focal_px, store_, report);
  give_birth(births, params_, store_, report);
}

ModelView Pipeline::model() const {
  return {w_.geometry, w_.appearance, w_.tracks, params_.filter.bias_px / static_cast<float>(extract::kPitch),
          typical_misfit_};
}

}  // namespace accrete
