// From a configured pair of cameras to images, and what becomes of a camera that is gone.
#include "libcamera/source.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "text/sentence.h"

namespace accrete::hal::libcam {
namespace {

// What belongs together: the automatic, and what it decides.
struct Automatic {
  const char* name;
  const char* what;
  std::vector<std::string> values;
};
const std::vector<Automatic>& automatics() {
  static const std::vector<Automatic> all = {{"AeEnable", "exposure and gain", {"ExposureTime", "AnalogueGain"}},
                                             {"AwbEnable", "white balance", {"ColourGains"}}};
  return all;
}

bool names(const std::vector<LibcameraControl>& controls, const std::string& name) {
  return std::any_of(controls.begin(), controls.end(), [&name](const LibcameraControl& c) { return c.name == name; });
}

// Once: a stream may be started more than once.
void say(LiveDeviceStatistics& statistics, const std::string& notice) {
  if (std::find(statistics.notices.begin(), statistics.notices.end(), notice) == statistics.notices.end())
    statistics.notices.push_back(notice);
}

}  // namespace

Source::Source(std::unique_ptr<Cameras> cameras, LibcameraOptions options)
    : PairedSource(static_cast<const LiveOptions&>(options)),
      cameras_(std::move(cameras)),
      controls_(std::move(options.controls)) {}

std::string Source::who(Eye eye) const { return at(eye).id + " (" + at(eye).model + ")"; }

int Source::fewest_buffers() const {
  return two() ? std::min(left_.negotiated.buffers, right_.negotiated.buffers) : left_.negotiated.buffers;
}

std::int64_t Source::now_ns() const { return std::chrono::steady_clock::now().time_since_epoch().count(); }

void Source::sleep_until(std::int64_t t_ns) {
  std::this_thread::sleep_until(std::chrono::steady_clock::time_point(std::chrono::nanoseconds(t_ns)));
}

// The camera manager goes, too: it is made anew before a camera can be back. One that sees a camera return crashes in
// libcamera 0.0.3 (its list of devices keeps a pointer to the old one; mended in 0.0.5).
void Source::close_all() {
  for (Side* side : {&left_, &right_}) side->device.reset();
  mailbox_.clear();
  cameras_->stop();
}

// What a camera is told before its first image.
std::vector<LibcameraControl> Source::at_start(const Side& side) const {
  std::vector<LibcameraControl> controls = controls_;
  const auto add = [&](const LibcameraControl& control) {
    if (!names(controls, control.name) && side.device->has_control(control.name)) controls.push_back(control);
  };
  if (options().rate_hz > 0) {
    const std::string us = std::to_string(std::llround(1e6 / options().rate_hz));
    add({"FrameDurationLimits", us + "," + us});
  }
  if (!locked_.empty())
    for (const LibcameraControl& control : locked_) add(control);
  else if (options().lock_exposure && options().warm_up_frames > 0)
    for (const Automatic& automatic : automatics()) add({automatic.name, "true"});
  return controls;
}

Outcome Source::start_streams() {
  Outcome o;
  if (!left_.device) {
    o = cameras_->start();
    if (o.ok()) o = open_and_configure(*left_.negotiated.known);
  }
  for (const Eye eye : camera::eyes_of(options().layout)) {
    if (!o.ok()) break;
    Side& side = at(eye);
    side.arrivals = {};
    side.device->set(at_start(side));
    o = side.device->start(eye, mailbox_);
    if (!o.ok()) o.message = who(eye) + ": " + o.message;
  }
  if (!o.ok()) close_all();
  return o;
}

void Source::stop_streams() {
  for (Side* side : {&left_, &right_})
    if (side->device) side->device->stop();
  mailbox_.clear();
}

void Source::give_back(Eye eye, int slot) {
  if (at(eye).device) at(eye).device->give_back(slot);
}

void Source::collect(std::int64_t deadline_ns) {
  Letter letter;
  if (mailbox_.pop(deadline_ns, letter)) take(letter);
}

void Source::take(const Letter& letter) {
  Side& side = at(letter.eye);
  if (letter.what == Letter::What::kGone) return lose(who(letter.eye) + ": it is gone");
  side.statistics.dropped += side.arrivals.count(letter.sequence);
  if (letter.what == Letter::What::kDamaged || camera::check(side.device->raw(letter.slot)) != nullptr ||
      !side.arrivals.later(letter.t_ns)) {
    ++side.statistics.damaged;
    return side.device->give_back(letter.slot);
  }
  side.statistics.clock = letter.of_exposure ? LiveClock::kStartOfExposure : LiveClock::kEndOfFrame;
  ++side.statistics.arrived;
  arrived(letter.eye, {letter.slot, letter.t_ns, side.arrivals.sequence()});
}

// The left camera's values, for both.
void Source::lock_exposure() {
  for (const Automatic& automatic : automatics()) {
    if (names(controls_, automatic.name)) continue;  // the user's affair
    if (!left_.device->has_control(automatic.name)) {
      say(left_.statistics, std::string("it cannot fix its ") + automatic.what + ": the camera may change it");
      continue;
    }
    locked_.push_back({automatic.name, "false"});
    for (const LibcameraControl& value : left_.device->reported(automatic.values))
      if (!names(controls_, value.name)) locked_.push_back(value);
    if (!names(locked_, automatic.values[0]) && !names(controls_, automatic.values[0]))
      say(left_.statistics, "it does not say what its " + automatic.values[0] +
                                " is: each camera keeps its own; give it as a control, the same to both");
  }
  for (const Eye eye : camera::eyes_of(options().layout)) {
    Side& side = at(eye);
    std::vector<LibcameraControl> possible;
    side.statistics.locked.clear();
    for (const LibcameraControl& control : locked_) {
      if (!side.device->has_control(control.name) || !side.device->check(control).ok()) {
        say(side.statistics, control.name + " cannot be set to " + control.value);
        continue;
      }
      possible.push_back(control);
      side.statistics.locked.push_back(control.name + " " + control.value);
    }
    side.device->set(possible);
  }
}

}  // namespace accrete::hal::libcam
