#include "record/frame_queue.h"

#include <algorithm>
#include <cstring>

namespace accrete::hal {
namespace {

std::size_t row_bytes(const ImageView& image) {
  return static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(channels(image.format));
}
std::size_t bytes_of(const ImageView& image) { return row_bytes(image) * static_cast<std::size_t>(image.height_px); }

ImageView copy(const ImageView& from, std::vector<std::uint8_t>& bytes) {
  const std::size_t row = row_bytes(from);
  bytes.resize(bytes_of(from));
  for (int y = 0; y < from.height_px; ++y)
    std::memcpy(bytes.data() + static_cast<std::size_t>(y) * row, from.row(y), row);
  ImageView view = from;
  view.data = bytes.data();
  view.stride_bytes = static_cast<std::ptrdiff_t>(row);
  return view;
}

}  // namespace

Status FrameQueue::put(const StereoFrame& frame, bool wait) {
  constexpr std::size_t kFewest = 3;  // one that is written, one that waits, one that is filled
  constexpr std::size_t kMost = 4096;
  QueuedFrame slot;
  {
    std::unique_lock lock(mutex_);
    if (capacity_ == 0)
      capacity_ = std::clamp(buffer_bytes_ / (bytes_of(frame.left) + bytes_of(frame.right)), kFewest, kMost);
    if (wait) freed_.wait(lock, [this] { return closed_ || in_use_ < capacity_; });
    if (closed_) return Status::kUnavailable;
    if (in_use_ == capacity_) return Status::kCapacityExceeded;
    ++in_use_;
    most_ = std::max(most_, in_use_);
    if (!free_.empty()) {
      slot = std::move(free_.back());
      free_.pop_back();
    }
  }
  slot.frame = frame;
  slot.frame.left = copy(frame.left, slot.left);
  slot.frame.right = copy(frame.right, slot.right);
  slot.taken = std::chrono::steady_clock::now();
  {
    const std::scoped_lock lock(mutex_);
    waiting_.push_back(std::move(slot));
  }
  filled_.notify_one();
  return Status::kOk;
}

const QueuedFrame* FrameQueue::front() {
  std::unique_lock lock(mutex_);
  filled_.wait(lock, [this] { return closed_ || !waiting_.empty(); });
  return waiting_.empty() ? nullptr : &waiting_.front();  // a deque moves nothing when others are added behind
}

void FrameQueue::done() {
  {
    const std::scoped_lock lock(mutex_);
    if (waiting_.empty()) return;
    free_.push_back(std::move(waiting_.front()));
    waiting_.pop_front();
    --in_use_;
  }
  freed_.notify_one();
}

void FrameQueue::close(bool drop) {
  {
    const std::scoped_lock lock(mutex_);
    closed_ = true;
    if (drop) waiting_.clear();
  }
  filled_.notify_all();
  freed_.notify_all();
}

std::size_t FrameQueue::capacity() const {
  const std::scoped_lock lock(mutex_);
  return capacity_;
}
std::size_t FrameQueue::most_waiting() const {
  const std::scoped_lock lock(mutex_);
  return most_;
}

}  // namespace accrete::hal
