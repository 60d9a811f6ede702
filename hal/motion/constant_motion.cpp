#include "accrete/hal/recording.h"

namespace accrete::hal {
namespace {

class ConstantMotion final : public MotionSource {
 public:
  explicit ConstantMotion(const Motion& motion) : motion_(motion) {}
  Outcome at(Timestamp t, Motion& motion) override {
    motion = motion_;
    motion.t = t;
    return {};
  }

 private:
  Motion motion_;
};

}  // namespace

Outcome constant_motion(const Motion& motion, std::unique_ptr<MotionSource>& source) {
  source.reset();
  if (validate(motion) != Status::kOk)
    return {Status::kInvalidArgument,
            "the constant motion is not finite, its quaternion not of unit length, or its covariance none"};
  source = std::make_unique<ConstantMotion>(motion);
  return {};
}

}  // namespace accrete::hal
