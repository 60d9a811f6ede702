// From options to acquired cameras with an agreed format.
#include <algorithm>
#include <charconv>

#include "libcamera/source.h"
#include "text/sentence.h"

namespace accrete::hal::libcam {

Outcome find_camera(const std::vector<LibcameraCamera>& cameras, const std::string& name, LibcameraCamera& found) {
  std::vector<LibcameraCamera> fitting;
  for (const LibcameraCamera& camera : cameras)
    if (camera.id == name) return found = camera, Outcome{};
  for (const LibcameraCamera& camera : cameras)
    if (camera.model == name) fitting.push_back(camera);
  std::size_t number = 0;
  const char* end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data(), end, number);
  if (fitting.empty() && error == std::errc{} && stop == end && number < cameras.size())
    fitting.push_back(cameras[number]);
  if (fitting.size() == 1) return found = fitting[0], Outcome{};
  std::string there;
  for (const LibcameraCamera& camera : cameras) there += (there.empty() ? "" : ", ") + camera.id;
  if (!fitting.empty())
    return {Status::kInvalidArgument,
            in_quotes(name) + " is the model of several cameras: name one of them by its id, " + there};
  return {Status::kNotFound, "libcamera has no camera " + in_quotes(name) + "; it has " +
                                 (there.empty() ? "none: is one connected, and its driver loaded?" : there)};
}

Outcome Source::check_format() const {
  const std::string& wanted = options().format;
  if (options().layout == StereoLayout::kInterleaved)
    return {Status::kUnsupported, "libcamera delivers no images pixel by pixel: use such a camera by V4L2"};
  const KnownFormat* known = wanted.empty() ? nullptr : find_format(wanted);
  if (wanted.empty() || (known != nullptr && understood(*known))) return {};
  std::string all;
  for (const KnownFormat& format : known_formats())
    if (understood(format)) all += (all.empty() ? "" : ", ") + std::string(format.name);
  return {Status::kUnsupported, "the format " + in_quotes(wanted) + " is not understood; understood are " + all};
}

Outcome Source::choose_cameras() {
  const std::vector<LibcameraCamera> all = cameras_->list();
  for (const Eye eye : camera::eyes_of(options().layout)) {
    LibcameraCamera found;
    if (Outcome o = find_camera(all, eye == Eye::kLeft ? options().left : options().right, found); !o.ok()) return o;
    Side& side = at(eye);
    side.id = side.statistics.node = side.statistics.id = found.id;
    side.model = side.statistics.card = found.model;
    side.statistics.bus = "libcamera";
  }
  if (two() && left_.id == right_.id) return {Status::kInvalidArgument, "left and right are one camera, " + left_.id};
  return {};
}

// Formats that may serve, the best first: those that all cameras list.
std::vector<const KnownFormat*> Source::candidates() const {
  if (!options().format.empty()) return {find_format(options().format)};
  std::vector<const KnownFormat*> result;
  for (const KnownFormat& known : known_formats()) {
    bool everywhere = understood(known);
    for (const Eye eye : camera::eyes_of(options().layout)) {
      const std::vector<std::string> listed = at(eye).device->formats();
      everywhere = everywhere && std::find(listed.begin(), listed.end(), known.name) != listed.end();
    }
    if (everywhere) result.push_back(&known);
  }
  return result;
}

// By the ids of choose_cameras().
Outcome Source::open_and_configure(const KnownFormat& format) {
  for (const Eye eye : camera::eyes_of(options().layout)) {
    Side& side = at(eye);
    Outcome o;
    if (!side.device) o = cameras_->open(side.id, side.device);
    if (o.ok())
      o = side.device->configure(format, camera::buffer_size(options().layout, wanted_size()), options().buffers,
                                 side.negotiated);
    if (!o.ok()) return {o.status, who(eye) + ": " + o.message};
    side.statistics.format = format.name;
    side.statistics.width_px = side.negotiated.size.width_px;
    side.statistics.height_px = side.negotiated.size.height_px;
    const bool paced = side.device->has_control("FrameDurationLimits");
    side.statistics.rate_hz = paced ? options().rate_hz : 0;
    const std::string notice = "its rate cannot be set by libcamera: it runs at its own";
    if (options().rate_hz > 0 && !paced && side.statistics.notices.empty()) side.statistics.notices.push_back(notice);
  }
  return {};
}

Outcome Source::configure_devices() {
  if (Outcome o = check_format(); !o.ok()) return o;
  if (Outcome o = cameras_->start(); !o.ok()) return o;
  if (Outcome o = choose_cameras(); !o.ok()) return o;
  for (const Eye eye : camera::eyes_of(options().layout)) {
    Side& side = at(eye);
    if (Outcome o = cameras_->open(side.id, side.device); !o.ok()) return {o.status, who(eye) + ": " + o.message};
    for (const LibcameraControl& control : controls_)
      if (Outcome o = side.device->check(control); !o.ok()) return {o.status, who(eye) + ": " + o.message};
  }
  Outcome failure{Status::kUnsupported, "the cameras share no format that is understood"};
  for (const KnownFormat* known : candidates()) {
    failure = open_and_configure(*known);
    if (failure.status != Status::kUnsupported) break;
  }
  return failure;
}

}  // namespace accrete::hal::libcam
