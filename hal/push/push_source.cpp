#include "accrete/hal/push_source.h"

#include "push/push_queue.h"

namespace accrete::hal {
namespace {

// Calls `release` when the last image that borrows the pixels has gone.
std::shared_ptr<const void> borrowed(PushSource::Release release) {
  if (!release) return nullptr;
  auto owner = std::make_unique<PushSource::Release>(std::move(release));
  return {static_cast<const void*>(owner.release()), [](const void* p) {
            const std::unique_ptr<const PushSource::Release> last(static_cast<const PushSource::Release*>(p));
            (*last)();
          }};
}

}  // namespace

PushSource::PushSource(const PushSettings& settings)
    : settings_(settings), queue_(std::make_unique<PushQueue>(settings)) {}
PushSource::~PushSource() { stop(); }

Status PushSource::push(const StereoFrame& frame, Release release) {
  return queue_->push(frame, borrowed(std::move(release)));
}
Status PushSource::push_left(const ImageView& image, Timestamp t, Release release) {
  return queue_->push(PushQueue::Side::kLeft, image, t, borrowed(std::move(release)));
}
Status PushSource::push_right(const ImageView& image, Timestamp t, Release release) {
  return queue_->push(PushQueue::Side::kRight, image, t, borrowed(std::move(release)));
}

void PushSource::close() { queue_->close(); }
PushCounters PushSource::pushed() const { return queue_->counters(); }

Outcome PushSource::do_configure() {
  if (settings_.capacity < 1 || settings_.capacity > 1000)
    return {Status::kInvalidArgument, "a push source holds 1 to 1000 pairs: change PushSettings::capacity"};
  if (settings_.max_skew_ns < 0) return {Status::kInvalidArgument, "PushSettings::max_skew_ns must be zero or more"};
  rig_ = settings_.rig;
  return {};
}

Outcome PushSource::do_start() {
  queue_->open();
  return {};
}

Outcome PushSource::do_acquire(std::int64_t timeout_ns, StereoFrame& frame) {
  const Status status = queue_->take(timeout_ns, frame);
  const PushCounters now = queue_->counters();
  counters_.dropped = now.overwritten;
  counters_.unpaired = now.unpaired;
  if (status == Status::kTimeout) return {status, "no pair of images was pushed in time"};
  if (status == Status::kEndOfStream) return {status, "the push source was closed"};
  return {status, {}};
}

void PushSource::do_release() { queue_->give_back(); }
void PushSource::do_stop() { queue_->stop(); }

}  // namespace accrete::hal
