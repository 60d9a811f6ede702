#include "camera.h"

#include <linux/usb/ch9.h>

#include <algorithm>
#include <ctime>

namespace accrete::vm {
namespace {

constexpr std::int64_t kLong = 1'000'000'000;
// Interfaces and their selectors in the video class.
constexpr std::uint8_t kControlInterface = 0, kStreamInterface = 1, kProbe = 1, kCommit = 2;
constexpr std::uint32_t kStreamEndpoint = 1;
// Bits of a payload's header.
constexpr std::uint8_t kEndOfFrame = 0x02, kError = 0x40, kEndOfHeader = 0x80;

}  // namespace

std::int64_t now_ns() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

void Camera::unplug() {
  link_.reset();
  pending_.clear();
  overtaken_.clear();
  streaming_ = in_frame_ = false;
  controls_ = {};
}

void Camera::serve() {
  UsbRequest request;
  if (!link_->receive(request) || !answer(request)) unplug();
}

bool Camera::answer(const UsbRequest& request) {
  if (request.unlink) {
    // vhci_hcd has a queue for requests and one for what is given up, and may send the second one first. Answered at
    // once, it would take the request's own answer for a broken connection, and unplug the camera.
    if (request.unlinked > newest_) {
      overtaken_[request.unlinked] = request.sequence;
      return true;
    }
    const auto found = std::find_if(pending_.begin(), pending_.end(),
                                    [&](const Pending& p) { return p.sequence == request.unlinked; });
    const bool pending = found != pending_.end();
    if (pending) pending_.erase(found);
    return link_->confirm_unlink(request.sequence, pending);
  }
  newest_ = request.sequence;
  if (const auto given_up = overtaken_.extract(request.sequence)) return link_->confirm_unlink(given_up.mapped(), true);
  if (request.endpoint == kStreamEndpoint && request.in) {
    pending_.push_back({request.sequence, request.length});
    return true;
  }
  Bytes reply;
  if (request.endpoint != 0 || !control(request, reply)) return link_->refuse(request.sequence);
  if (!request.in) return link_->accept_data(request.sequence, request.length);
  reply.resize(std::min<std::size_t>(reply.size(), request.length));
  return link_->send_data(request.sequence, reply);
}

// False: not understood, to be answered with a stall.
bool Camera::control(const UsbRequest& request, Bytes& reply) {
  const auto& setup = request.setup;  // type, request, value (2), index (2), length (2)
  if ((setup[0] & USB_TYPE_MASK) == USB_TYPE_CLASS) return video_control(request, reply);
  switch (setup[1]) {
    case USB_REQ_GET_DESCRIPTOR:
      if (setup[3] == USB_DT_DEVICE) reply = device_descriptor();
      if (setup[3] == USB_DT_CONFIG) reply = configuration_descriptor(pictures_, rate_hz_);
      if (setup[3] == USB_DT_STRING) reply = string_descriptor(setup[2], number_);
      if (setup[3] == USB_DT_DEVICE_QUALIFIER) reply = qualifier_descriptor();
      return !reply.empty();
    case USB_REQ_GET_STATUS:
      reply = {0, 0};
      return true;
    case USB_REQ_GET_CONFIGURATION:
      reply = {1};
      return true;
    case USB_REQ_GET_INTERFACE:
      reply = {0};
      return true;
    case USB_REQ_CLEAR_FEATURE:  // of the stream's endpoint: uvcvideo ends a bulk stream so
      if (setup[0] == USB_RECIP_ENDPOINT) streaming_ = in_frame_ = false;
      return true;
    case USB_REQ_SET_CONFIGURATION:
    case USB_REQ_SET_INTERFACE:
    case USB_REQ_SET_FEATURE:
      return true;
    default:
      return false;
  }
}

bool Camera::video_control(const UsbRequest& request, Bytes& reply) {
  const std::uint8_t selector = request.setup[3], interface = request.setup[4], entity = request.setup[5];
  const Ask ask{request.setup[1]};
  if (interface == kControlInterface) return controls_.answer(entity, selector, ask, request.data, reply);
  if (interface != kStreamInterface || (selector != kProbe && selector != kCommit)) return false;
  if (ask == Ask::kSetCurrent) {
    if (request.data.size() < 3) return false;
    format_ = std::clamp<std::size_t>(request.data[2], 1, pictures_.formats().size()) - 1;
    if (selector != kCommit) return true;
    streaming_ = true;
    in_frame_ = false;
    due_ns_ = now_ns();
    return true;
  }
  reply = stream_proposal(pictures_, format_, rate_hz_);
  if (ask == Ask::kInfo) reply = {3};
  if (ask == Ask::kLength) reply = {static_cast<std::uint8_t>(reply.size()), 0};
  return true;
}

std::int64_t Camera::last_tick(std::int64_t now) const {
  const std::int64_t since = now - playback_.epoch_ns - faults.late_ns;
  return since < 0 ? -1 : since / playback_.period_ns;
}

// False: this one is not sent.
bool Camera::begin_frame(std::int64_t tick) {
  if (faults.drop > 0) return --faults.drop, false;
  const std::uint64_t number =
      (playback_.number + (playback_.held ? 0 : static_cast<std::uint64_t>(tick))) % pictures_.size();
  pictures_.encode(number, pictures_.formats()[format_], frame_);
  if (faults.cut > 0) frame_.resize(frame_.size() / 2), --faults.cut;
  flagged_ = faults.flag > 0;
  if (flagged_) --faults.flag;
  sent_ = 0;
  in_frame_ = true;
  toggle_ ^= 1;
  return true;
}

std::int64_t Camera::send() {
  if (!link_ || !streaming_) return kLong;
  if (!in_frame_ && playback_.held) return kLong;
  if (!in_frame_) {
    const std::int64_t now = now_ns();
    if (now < faults.still_until_ns) return faults.still_until_ns - now;
    const std::int64_t tick = last_tick(now);
    const std::int64_t start = playback_.epoch_ns + faults.late_ns;  // of tick 0
    const std::int64_t begin = start + tick * playback_.period_ns;
    // A camera that missed the moment of a picture leaves it out: late, it would lie nearer to the next one of the
    // other camera than to its own partner.
    if (tick < 0 || begin < due_ns_ || now > begin + playback_.period_ns / 8)
      return std::max<std::int64_t>(start + (tick + 1) * playback_.period_ns - now, 0);
    due_ns_ = begin + 1;
    if (!begin_frame(tick)) return 0;
  }
  if (pending_.empty()) return kLong;
  const Pending request = pending_.front();
  pending_.pop_front();
  Bytes header{2, static_cast<std::uint8_t>(kEndOfHeader | toggle_)};
  const std::size_t room = std::min<std::size_t>(request.length, kPayloadBytes) - header.size();
  const std::span<const std::uint8_t> rest = std::span(frame_).subspan(sent_, std::min(room, frame_.size() - sent_));
  sent_ += rest.size();
  if (sent_ == frame_.size()) {
    in_frame_ = false;
    header[1] |= kEndOfFrame;
    if (flagged_) header[1] |= kError;
  }
  if (!link_->send_data(request.sequence, header, rest)) unplug();
  return 0;
}

}  // namespace accrete::vm
