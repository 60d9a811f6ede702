#include "push/push_queue.h"

#include <algorithm>
#include <chrono>
#include <cstring>

namespace accrete::hal {
namespace {

void copy_rows(const ImageView& from, std::vector<std::uint8_t>& bytes) {
  const std::size_t row = static_cast<std::size_t>(from.width_px) * static_cast<std::size_t>(channels(from.format));
  bytes.resize(row * static_cast<std::size_t>(from.height_px));
  for (int y = 0; y < from.height_px; ++y)
    std::memcpy(bytes.data() + static_cast<std::size_t>(y) * row, from.row(y), row);
}

}  // namespace

void PushQueue::open() {
  const std::scoped_lock lock(mutex_);
  streaming_ = true;
  next_sequence_ = 0;
  last_left_.reset();
  counters_ = {};
}

void PushQueue::close() {
  {
    const std::scoped_lock lock(mutex_);
    closed_ = true;
  }
  arrived_.notify_all();
}

void PushQueue::stop() {
  Waste waste;
  const std::scoped_lock lock(mutex_);  // ends before `waste` does
  streaming_ = false;
  for (PushedPair& pair : pairs_) {
    discard(std::move(pair.left), waste);
    discard(std::move(pair.right), waste);
  }
  for (auto* side : {&left_, &right_}) {
    for (PushedImage& image : *side) discard(std::move(image), waste);
    side->clear();
  }
  pairs_.clear();
}

bool PushQueue::fits(const ImageView& image, const Camera& camera) const {
  return image.valid() &&
         (camera.width_px == 0 || (image.width_px == camera.width_px && image.height_px == camera.height_px));
}

Status PushQueue::refuse(Status status) {
  const std::scoped_lock lock(mutex_);
  ++counters_.refused;
  return status;
}

PushedImage PushQueue::keep(const ImageView& image, Timestamp t, const std::shared_ptr<const void>& borrowed) {
  PushedImage kept;
  kept.view = image;
  kept.t = t;
  kept.borrowed = borrowed;
  if (borrowed) return kept;
  {
    const std::scoped_lock lock(mutex_);
    if (!buffers_.empty()) {
      kept.copy = std::move(buffers_.back());
      buffers_.pop_back();
    }
  }
  copy_rows(image, kept.copy);
  kept.view.data = kept.copy.data();
  kept.view.stride_bytes = static_cast<std::ptrdiff_t>(image.width_px) * channels(image.format);
  return kept;
}

void PushQueue::discard(PushedImage&& image, Waste& waste) {
  // As many as can be in use at once: both sides of the pairs that wait and of the one that is lent, and the singles.
  if (!image.borrowed && buffers_.size() < 4 * settings_.capacity + 2)
    buffers_.push_back(std::move(image.copy));
  else
    waste.push_back(std::move(image));
}

void PushQueue::insert(PushedImage&& left, PushedImage&& right, Waste& waste) {
  last_left_ = left.t;
  pairs_.push_back({std::move(left), std::move(right), next_sequence_++});
  ++counters_.pushed;
  if (pairs_.size() <= settings_.capacity) return;
  discard(std::move(pairs_.front().left), waste);
  discard(std::move(pairs_.front().right), waste);
  pairs_.pop_front();
  ++counters_.overwritten;
}

void PushQueue::drop_older(std::deque<PushedImage>& side, Timestamp t, Waste& waste) {
  while (!side.empty() && side.front().t < t) {
    discard(std::move(side.front()), waste);
    side.pop_front();
    ++counters_.unpaired;
  }
}

Status PushQueue::push(const StereoFrame& frame, std::shared_ptr<const void> borrowed) {
  if (!fits(frame.left, settings_.rig.left) || !fits(frame.right, settings_.rig.right))
    return refuse(Status::kInvalidArgument);
  PushedImage left = keep(frame.left, frame.t_left, borrowed), right = keep(frame.right, frame.t_right, borrowed);
  borrowed.reset();  // the images have it now
  Waste waste;
  {
    const std::scoped_lock lock(mutex_);
    const bool open = streaming_ && !closed_;
    if (!open || (last_left_ && left.t <= *last_left_)) {
      ++counters_.refused;
      discard(std::move(left), waste);
      discard(std::move(right), waste);
      return open ? Status::kInvalidArgument : Status::kUnavailable;
    }
    drop_older(left_, left.t, waste);
    drop_older(right_, right.t, waste);
    insert(std::move(left), std::move(right), waste);
  }
  arrived_.notify_one();
  return Status::kOk;
}

Status PushQueue::push(Side side, const ImageView& image, Timestamp t, std::shared_ptr<const void> borrowed) {
  const bool is_left = side == Side::kLeft;
  if (!fits(image, is_left ? settings_.rig.left : settings_.rig.right)) return refuse(Status::kInvalidArgument);
  PushedImage kept = keep(image, t, borrowed);
  borrowed.reset();
  Waste waste;
  {
    const std::scoped_lock lock(mutex_);
    auto& mine = is_left ? left_ : right_;
    auto& theirs = is_left ? right_ : left_;
    const bool open = streaming_ && !closed_;
    if (!open || (!mine.empty() && t <= mine.back().t)) {
      ++counters_.refused;
      discard(std::move(kept), waste);
      return open ? Status::kInvalidArgument : Status::kUnavailable;
    }
    const auto partner = std::min_element(
        theirs.begin(), theirs.end(),
        [t](const PushedImage& a, const PushedImage& b) { return std::abs(a.t - t) < std::abs(b.t - t); });
    if (partner == theirs.end() || std::abs(partner->t - t) > settings_.max_skew_ns) {
      mine.push_back(std::move(kept));
      if (mine.size() > settings_.capacity) {
        discard(std::move(mine.front()), waste);
        mine.pop_front();
        ++counters_.unpaired;
      }
      return Status::kOk;
    }
    PushedImage other = std::move(*partner);
    theirs.erase(partner);
    drop_older(theirs, other.t, waste);
    drop_older(mine, t, waste);
    PushedImage& left = is_left ? kept : other;
    PushedImage& right = is_left ? other : kept;
    if (last_left_ && left.t <= *last_left_) {
      counters_.unpaired += 2;  // both came after a pair that is younger
      discard(std::move(left), waste);
      discard(std::move(right), waste);
      return Status::kOk;
    }
    insert(std::move(left), std::move(right), waste);
  }
  arrived_.notify_one();
  return Status::kOk;
}

Status PushQueue::take(std::int64_t timeout_ns, StereoFrame& frame) {
  // Further away than anybody waits; steady_clock would overflow beyond.
  constexpr std::int64_t kLongest_ns = 1'000'000'000'000'000;
  const auto until = std::chrono::steady_clock::now() + std::chrono::nanoseconds(std::min(timeout_ns, kLongest_ns));
  std::unique_lock lock(mutex_);
  if (!arrived_.wait_until(lock, until, [this] { return closed_ || !pairs_.empty(); })) return Status::kTimeout;
  if (pairs_.empty()) return Status::kEndOfStream;
  lent_ = std::move(pairs_.front());
  pairs_.pop_front();
  ++counters_.delivered;
  frame.left = lent_->left.view;
  frame.right = lent_->right.view;
  frame.t_left = lent_->left.t;
  frame.t_right = lent_->right.t;
  frame.sequence = lent_->sequence;
  return Status::kOk;
}

void PushQueue::give_back() {
  Waste waste;
  const std::scoped_lock lock(mutex_);
  if (!lent_) return;
  discard(std::move(lent_->left), waste);
  discard(std::move(lent_->right), waste);
  lent_.reset();
}

PushCounters PushQueue::counters() const {
  const std::scoped_lock lock(mutex_);
  return counters_;
}

}  // namespace accrete::hal
