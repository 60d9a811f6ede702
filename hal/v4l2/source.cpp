#include "v4l2/source.h"

#include <algorithm>
#include <cerrno>

namespace accrete::hal::v4l2 {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

}  // namespace

Source::Source(Kernel& kernel, LiveOptions options)
    : PairedSource(std::move(options)), kernel_(kernel), left_(kernel), right_(kernel), exposure_(kernel) {}

std::vector<Source::Device*> Source::devices() {
  if (two()) return {&left_, &right_};
  return {&left_};
}

Size Source::negotiated_size(Eye eye) const {
  const NegotiatedFormat& format = at(eye).capture.format();
  return {format.width_px, format.height_px};
}

int Source::fewest_buffers() const {
  return two() ? std::min(left_.capture.buffers(), right_.capture.buffers()) : left_.capture.buffers();
}

void Source::close_all() {
  left_.capture.close();
  right_.capture.close();
}

// A device that came back under another node, or that was never away.
Outcome Source::open_again(Device& device) {
  const std::string node = find_again(kernel_, device.identity);
  if (node.empty())
    return {Status::kNotFound,
            (device.identity.link.empty() ? device.identity.node : device.identity.link) + " is not there"};
  const NegotiatedFormat format = device.capture.format();  // of before
  if (Outcome o = device.capture.open(node); !o.ok()) return o;
  const Capability& found = device.capture.capability();
  if (device.identity.link.empty() && (found.card != device.identity.card || found.bus != device.identity.bus)) {
    device.capture.close();
    return {Status::kNotFound, node + " is another camera now (" + found.card + " instead of " + device.identity.card +
                                   "); one with a link in /dev/v4l would be found again"};
  }
  return device.capture.negotiate({format.known, format.width_px, format.height_px, options().rate_hz});
}

Outcome Source::start_streams() {
  Outcome o;
  for (Device* device : devices())
    if (o.ok() && !device->capture.is_open()) o = open_again(*device);
  for (Device* device : devices()) {
    if (!o.ok()) break;
    if (exposure_.locked())
      exposure_.apply(device->capture.fd(), device->capture.statistics);
    else if (options().lock_exposure && options().warm_up_frames > 0)
      exposure_.make_automatic(device->capture.fd());
    o = device->capture.prepare(options().buffers);
  }
  for (Device* device : devices())
    if (o.ok()) o = device->capture.stream_on();
  if (!o.ok()) close_all();
  return o;
}

void Source::stop_streams() {
  left_.capture.stop();
  right_.capture.stop();
}

void Source::lock_exposure() {
  exposure_.lock(left_.capture.fd(), left_.capture.statistics, two() ? right_.capture.fd() : -1,
                 right_.capture.statistics);
}

void Source::collect(std::int64_t deadline_ns) {
  pollfd fds[2] = {{left_.capture.fd(), POLLIN, 0}, {right_.capture.fd(), POLLIN, 0}};
  const unsigned count = two() ? 2 : 1;
  const int ready = wait(kernel_, fds, count, deadline_ns);
  if (ready < 0) return lose("waiting for images fails: " + error_text(errno));
  if (ready == 0) {
    if (kernel_.now_ns() < deadline_ns) interrupted();
    return;
  }
  if (fds[0].revents != 0) take_from(Eye::kLeft, fds[0].revents, deadline_ns);
  if (two() && fds[1].revents != 0 && right_.capture.streaming()) take_from(Eye::kRight, fds[1].revents, deadline_ns);
}

void Source::take_from(Eye eye, short revents, std::int64_t deadline_ns) {
  Capture::Image image;
  switch (at(eye).capture.take(revents, image)) {
    case Capture::Took::kImage:
      return arrived(eye, {image.slot, image.t_ns, image.sequence});
    case Capture::Took::kNothing:  // poll() promised one: no busy loop
      wait(kernel_, nullptr, 0, std::min(deadline_ns, kernel_.now_ns() + kMillisecond));
      return;
    case Capture::Took::kDamaged:
      return;
    case Capture::Took::kLost:
      return lose(at(eye).capture.loss());
  }
}

}  // namespace accrete::hal::v4l2
