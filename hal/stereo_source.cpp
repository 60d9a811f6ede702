#include "accrete/hal/stereo_source.h"

#include "accrete/contract.h"

namespace accrete::hal {

Outcome StereoSource::configure() {
  if (state_ != SourceState::kClosed)
    return {Status::kUnavailable, "the stereo source is configured already: make a new one instead"};
  Outcome outcome = do_configure();
  if (outcome.ok()) state_ = SourceState::kConfigured;
  return outcome;
}

Outcome StereoSource::start() {
  if (state_ == SourceState::kClosed)
    return {Status::kUnavailable, "the stereo source is not configured: call configure() before start()"};
  if (state_ == SourceState::kStreaming)
    return {Status::kUnavailable, "the stereo source is streaming already: call stop() before start()"};
  Outcome outcome = do_start();
  if (outcome.ok()) state_ = SourceState::kStreaming;
  return outcome;
}

Outcome StereoSource::acquire(std::int64_t timeout_ns, StereoFrame& frame) {
  if (state_ != SourceState::kStreaming)
    return {Status::kUnavailable, "the stereo source is not streaming: call start() before acquire()"};
  if (lent_) return {Status::kUnavailable, "the last frame is still lent: call release() before acquire()"};
  if (timeout_ns < 0) return {Status::kInvalidArgument, "acquire() needs a timeout of zero or more nanoseconds"};
  frame = {};
  Outcome outcome = do_acquire(timeout_ns, frame);
  if (outcome.ok()) {
    ACCRETE_EXPECTS(frame.left.valid() && frame.right.valid());  // the back-end's duty
    lent_ = true;
    ++counters_.delivered;
  } else {
    frame = {};
    if (outcome.status == Status::kDataLoss) ++counters_.dropped;
  }
  return outcome;
}

void StereoSource::release() {
  if (!lent_) return;
  lent_ = false;
  do_release();
}

void StereoSource::stop() {
  if (state_ != SourceState::kStreaming) return;
  release();
  do_stop();
  state_ = SourceState::kConfigured;
}

}  // namespace accrete::hal
