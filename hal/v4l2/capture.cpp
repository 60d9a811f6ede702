#include "v4l2/capture.h"

#include <linux/videodev2.h>

#include <cerrno>

#include "camera/pairer.h"

namespace accrete::hal::v4l2 {

std::string Capture::who() const { return capability_.card.empty() ? node_ : node_ + " (" + capability_.card + ")"; }

std::uint32_t Capture::type() const {
  return capability_.multiplanar ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
}

Outcome Capture::open(const std::string& node) {
  close();
  node_ = node;
  capability_ = {};
  fd_ = open_retrying(kernel_, node.c_str());
  if (fd_ < 0) {
    const int error = errno;
    return {status_of(error), node + " cannot be opened: " + error_text(error)};
  }
  if (!query_capability(kernel_, fd_, capability_)) {
    const int error = errno;
    close();
    return {status_of(error), node + " does not answer as a camera: " + error_text(error)};
  }
  if (!capability_.captures) {
    const std::string name = who();
    close();
    return {Status::kUnsupported,
            name + " does not stream video; a camera may have several nodes, accrete devices shows the right ones"};
  }
  statistics.node = node;
  statistics.card = capability_.card;
  statistics.bus = capability_.bus;
  return {};
}

Outcome Capture::negotiate(const FormatRequest& request) {
  statistics.notices.clear();
  Outcome o = v4l2::negotiate(kernel_, fd_, capability_, who(), request, format_, statistics.notices);
  if (!o.ok()) return o;
  statistics.format = format_.known->name;
  statistics.width_px = format_.width_px;
  statistics.height_px = format_.height_px;
  statistics.rate_hz = format_.rate_hz;
  return o;
}

Outcome Capture::prepare(int buffers) {
  if (Outcome o = buffers_.request(fd_, type(), buffers, format_.buffer_planes, who()); !o.ok()) return o;
  slots_.assign(static_cast<std::size_t>(buffers_.count()), {});
  owed_.clear();
  refusals_ = 0;
  arrivals_ = {};
  for (int slot = 0; slot < buffers_.count(); ++slot)
    for (int attempt = 1; !queue(slot); ++attempt) {
      const int error = errno;
      if (attempt < kMaxAttempts && error != ENODEV) continue;
      buffers_.release();
      return {status_of(error), who() + ": it does not take its buffers: " + error_text(error)};
    }
  return {};
}

Outcome Capture::stream_on() {
  int error = 0;
  for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
    int its_type = static_cast<int>(type());
    if (ioctl_retrying(kernel_, fd_, VIDIOC_STREAMON, &its_type) == 0) {
      streaming_ = true;
      return {};
    }
    error = errno;
    if (error == ENODEV) break;
  }
  std::string text = who() + " does not start: " + error_text(error);
  if (error == ENOSPC) text += " (the USB bus is full: MJPG, a lower rate or another port need less of it)";
  return {status_of(error), text};
}

void Capture::stop() {
  if (fd_ < 0) return;
  if (streaming_) {
    int its_type = static_cast<int>(type());
    ioctl_retrying(kernel_, fd_, VIDIOC_STREAMOFF, &its_type);  // fails where the device is gone: it has stopped then
  }
  streaming_ = false;
  buffers_.release();
  slots_.clear();
  owed_.clear();
}

void Capture::close() {
  if (fd_ < 0) return;
  stop();
  kernel_.close(fd_);  // Linux has closed it also where it says EINTR
  fd_ = -1;
}

bool Capture::queue(int slot) {
  v4l2_buffer raw{};
  v4l2_plane raw_planes[VIDEO_MAX_PLANES]{};
  raw.index = static_cast<std::uint32_t>(slot);
  raw.type = type();
  raw.memory = V4L2_MEMORY_MMAP;
  if (capability_.multiplanar) {
    raw.m.planes = raw_planes;
    raw.length = static_cast<std::uint32_t>(format_.buffer_planes);
    for (int i = 0; i < format_.buffer_planes; ++i)
      raw_planes[i].length = static_cast<std::uint32_t>(buffers_.plane(slot, i).size());
  }
  if (ioctl_retrying(kernel_, fd_, VIDIOC_QBUF, &raw) < 0) return false;
  slots_[static_cast<std::size_t>(slot)].with_driver = true;
  return true;
}

void Capture::give_back(int slot) {
  if (!streaming_ || slot < 0 || slot >= buffers_.count()) return;  // of a stream that has ended
  if (!queue(slot)) {
    owed_.push_back(slot);
    ++refusals_;
  } else {
    refusals_ = 0;
  }
}

bool Capture::queue_owed() {
  while (!owed_.empty()) {
    if (!queue(owed_.back())) return ++refusals_ < 4 * kMaxAttempts;
    owed_.pop_back();
    refusals_ = 0;
  }
  return true;
}

Capture::Took Capture::lose(const std::string& why) {
  loss_ = who() + ": " + why;
  return Took::kLost;
}

Capture::Took Capture::discard(int slot) {
  ++statistics.damaged;
  give_back(slot);
  return Took::kDamaged;
}

bool Capture::stamp(std::uint32_t flags, std::int64_t stamp_ns, Image& image) {
  const bool monotonic = (flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  if (monotonic && stamp_ns != 0) {
    image.t_ns = stamp_ns;
    statistics.clock = (flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE
                           ? LiveClock::kStartOfExposure
                           : LiveClock::kEndOfFrame;
  } else {
    image.t_ns = kernel_.now_ns();
    statistics.clock = LiveClock::kArrival;
  }
  return arrivals_.later(image.t_ns);
}

Capture::Took Capture::take(short revents, Image& image) {
  if (!streaming_) return lose("it is not streaming");
  if (!queue_owed()) return lose("it does not take its buffers back: " + error_text(errno));
  v4l2_buffer raw{};
  v4l2_plane raw_planes[VIDEO_MAX_PLANES]{};
  raw.type = type();
  raw.memory = V4L2_MEMORY_MMAP;
  if (capability_.multiplanar) {
    raw.m.planes = raw_planes;
    raw.length = VIDEO_MAX_PLANES;
  }
  if (ioctl_retrying(kernel_, fd_, VIDIOC_DQBUF, &raw) < 0) {
    const int error = errno;
    if (error != EAGAIN && error != EINTR) return lose("it delivers no more: " + error_text(error));
    if ((revents & POLLNVAL) != 0) return lose("its file is closed");
    if ((revents & (POLLERR | POLLHUP)) != 0) return lose("its stream has failed");
    return Took::kNothing;
  }
  if (raw.index >= slots_.size() || !slots_[raw.index].with_driver)
    return lose("it returns a buffer that it does not have");
  const auto slot_number = static_cast<int>(raw.index);
  Slot& slot = slots_[raw.index];
  slot.with_driver = false;
  image.slot = slot_number;
  statistics.dropped += arrivals_.count(raw.sequence);
  image.sequence = arrivals_.sequence();
  if ((raw.flags & V4L2_BUF_FLAG_ERROR) != 0) return discard(slot_number);
  for (int i = 0; i < format_.buffer_planes; ++i) {
    const auto plane = static_cast<std::size_t>(i);
    slot.begin[plane] = capability_.multiplanar ? raw_planes[i].data_offset : 0;
    slot.end[plane] = capability_.multiplanar ? raw_planes[i].bytesused : raw.bytesused;
    if (slot.end[plane] > buffers_.plane(slot_number, i).size() || slot.begin[plane] > slot.end[plane])
      return discard(slot_number);
  }
  if (check(this->raw(slot_number)) != nullptr) return discard(slot_number);
  // Seconds and microseconds; a clock near the end of 64-bit nanoseconds wraps without being undefined.
  const auto stamp_ns =
      static_cast<std::int64_t>(static_cast<std::uint64_t>(raw.timestamp.tv_sec) * 1'000'000'000U +
                                static_cast<std::uint64_t>(static_cast<std::int64_t>(raw.timestamp.tv_usec)) * 1000U);
  if (!stamp(raw.flags, stamp_ns, image)) return discard(slot_number);
  ++statistics.arrived;
  return Took::kImage;
}

RawImage Capture::raw(int slot) const {
  const Slot& s = slots_[static_cast<std::size_t>(slot)];
  const auto bytes = [&](int plane) {
    const auto i = static_cast<std::size_t>(plane);
    return buffers_.plane(slot, plane).subspan(s.begin[i], s.end[i] - s.begin[i]);
  };
  RawImage image{format_.known->raw, format_.width_px, format_.height_px, format_.colour, {}};
  if (format_.known->separate_planes)
    for (int i = 0; i < format_.buffer_planes; ++i)
      image.planes[static_cast<std::size_t>(i)] = {bytes(i), format_.stride_bytes[static_cast<std::size_t>(i)]};
  else
    image.planes = split_planes(image.format, image.width_px, image.height_px, format_.stride_bytes[0], bytes(0));
  return image;
}

}  // namespace accrete::hal::v4l2
