// From options to opened devices with an agreed format.
#include <algorithm>
#include <cmath>

#include "calibration/calibration.h"
#include "text/sentence.h"
#include "v4l2/enumerate.h"
#include "v4l2/live_source.h"

namespace accrete::hal::v4l2 {

Outcome LiveSource::check_options() const {
  const auto bad = [](const std::string& text) -> Outcome { return {Status::kInvalidArgument, text}; };
  const V4l2Options& o = options_;
  if (two() && o.right.empty())
    return bad("one camera is named: name the right one, too, or say how one device delivers both images (the layout)");
  if (!two() && !o.right.empty())
    return bad(std::string("two cameras are named, but the layout ") + to_string(o.layout) + " is that of one device");
  if (o.buffers < 3 || o.buffers > 32) return bad(std::to_string(o.buffers) + " buffers: give 3 to 32");
  if (o.warm_up_frames < 0 || o.warm_up_frames > 1000)
    return bad(std::to_string(o.warm_up_frames) + " frames to warm up: give 0 to 1000");
  if (o.width_px < 0 || o.height_px < 0 || o.width_px > kMaxImageSide_px || o.height_px > kMaxImageSide_px ||
      (o.width_px == 0) != (o.height_px == 0))
    return bad(size_text(o.width_px, o.height_px) + " is no size of an image: give up to " +
               size_text(kMaxImageSide_px, kMaxImageSide_px) + ", or 0x0 for the calibration's");
  if (o.rate_hz != 0 && !(o.rate_hz >= 0.001 && o.rate_hz <= 100'000))
    return bad(accrete::hal::number(o.rate_hz) + " is no frame rate: give 0.001 to 100000 Hz, or 0 for the camera's");
  if (o.pair_tolerance_ns < 0) return bad("a tolerance between the times of two images cannot be negative");
  if (o.reconnect_timeout_ns < 0) return bad("a time to look for a lost camera cannot be negative");
  const KnownFormat* known = o.fourcc.empty() ? nullptr : find_format(o.fourcc);
  if (!o.fourcc.empty() && (known == nullptr || !understood(*known))) {
    std::string names;
    for (const KnownFormat& format : known_formats())
      if (understood(format)) names += (names.empty() ? "" : ", ") + std::string(format.name);
    return {Status::kUnsupported, "the format " + in_quotes(o.fourcc) + " is not understood; understood are " + names};
  }
  if (known != nullptr && (known->raw == RawFormat::kY8i) != (o.layout == V4l2Layout::kInterleaved))
    return bad(std::string("the format ") + known->name + " does not fit the layout " + to_string(o.layout) +
               ": Y8I belongs to y8i, and to no other");
  return {};
}

Outcome LiveSource::read_calibration() {
  eye_ = {options_.width_px, options_.height_px};
  rig_ = {};
  if (options_.calibration.empty()) return {};
  Calibration calibration;
  if (Outcome o = read_calibration_file(options_.calibration, KittiPair::kGrey, calibration); !o.ok()) return o;
  rig_ = calibration.rig;
  if (rig_.left.width_px != rig_.right.width_px || rig_.left.height_px != rig_.right.height_px)
    return {Status::kUnsupported,
            calibration.source + " has eyes of different sizes: " + size_text(rig_.left.width_px, rig_.left.height_px) +
                " and " + size_text(rig_.right.width_px, rig_.right.height_px)};
  if (rig_.left.width_px == 0) return {};
  if (eye_.width_px == 0) eye_ = {rig_.left.width_px, rig_.left.height_px};
  if (eye_.width_px != rig_.left.width_px || eye_.height_px != rig_.left.height_px)
    return {
        Status::kInvalidArgument,
        "an eye shall have " + size_text(eye_.width_px, eye_.height_px) + " pixels, but " + calibration.source +
            " is for " + size_text(rig_.left.width_px, rig_.left.height_px) +
            ": use the calibration's size, or calibrate at the other one (one device for both eyes: the size is that "
            "of one eye)"};
  return {};
}

Outcome LiveSource::do_configure() {
  if (Outcome o = check_options(); !o.ok()) return o;
  if (Outcome o = read_calibration(); !o.ok()) return o;
  Outcome o = configure_devices();
  if (!o.ok()) close_all();
  return o;
}

Outcome LiveSource::configure_devices() {
  std::string left, right;
  if (Outcome o = find_node(kernel_, options_.left, left); !o.ok()) return o;
  if (two()) {
    if (Outcome o = find_node(kernel_, options_.right, right); !o.ok()) return o;
    if (left == right)
      return {Status::kInvalidArgument, "left and right are one camera, " + left +
                                            ": cameras without a serial number share a name in /dev/v4l/by-id, the "
                                            "names in /dev/v4l/by-path tell them apart"};
  }
  if (Outcome o = left_.capture.open(left); !o.ok()) return o;
  if (two())
    if (Outcome o = right_.capture.open(right); !o.ok()) return o;
  const bool same_model = two() && left_.capture.capability().card == right_.capture.capability().card;
  for (Device* device : devices()) {
    device->identity = identify(kernel_, device == &left_ ? left : right, device->capture.capability(), same_model);
    device->capture.statistics.id = device->identity.link;
  }
  if (Outcome o = negotiate_all(); !o.ok()) return o;
  return settle_size();
}

// Formats that may serve, the best first: those that all devices list.
std::vector<const KnownFormat*> LiveSource::candidates() {
  std::vector<const KnownFormat*> result;
  if (!options_.fourcc.empty()) return {find_format(options_.fourcc)};
  std::vector<std::vector<V4l2Format>> lists;
  for (Device* device : devices())
    lists.push_back(enumerate_formats(kernel_, device->capture.fd(), device->capture.capability().multiplanar, false));
  for (const KnownFormat& known : known_formats()) {
    if (!understood(known) || (known.raw == RawFormat::kY8i) != (options_.layout == V4l2Layout::kInterleaved)) continue;
    const bool everywhere = std::all_of(lists.begin(), lists.end(), [&known](const std::vector<V4l2Format>& list) {
      return std::any_of(list.begin(), list.end(),
                         [&known](const V4l2Format& format) { return format.fourcc == known.name; });
    });
    if (everywhere) result.push_back(&known);
  }
  return result;
}

Outcome LiveSource::negotiate_with(const KnownFormat* known) {
  const Size buffer = buffer_size(options_.layout, eye_);
  for (Device* device : devices())
    if (Outcome o = device->capture.negotiate({known, buffer.width_px, buffer.height_px, options_.rate_hz}); !o.ok())
      return o;
  return {};
}

Outcome LiveSource::negotiate_all() {
  const std::vector<const KnownFormat*> formats = candidates();
  if (formats.empty()) {  // a driver that lists nothing: what it is set to
    if (Outcome o = negotiate_with(nullptr); !o.ok()) return o;
    if ((left_.capture.format().known->raw == RawFormat::kY8i) == (options_.layout == V4l2Layout::kInterleaved))
      return {};
    return {Status::kUnsupported, left_.capture.who() + " has no format for the layout " + to_string(options_.layout)};
  }
  Outcome failure;
  const KnownFormat* slow = nullptr;  // the first that fits but for its rate
  for (const KnownFormat* known : formats) {
    Outcome o = negotiate_with(known);
    if (!o.ok()) {
      if (o.status != Status::kUnsupported) return o;
      if (failure.ok()) failure = std::move(o);
      continue;
    }
    const double rate = left_.capture.format().rate_hz;
    if (options_.rate_hz == 0 || rate == 0 || rate > 0.95 * options_.rate_hz) return {};
    if (slow == nullptr) slow = known;
  }
  return slow != nullptr ? negotiate_with(slow) : failure;
}

Outcome LiveSource::settle_size() {
  for (Device* device : devices()) {
    const NegotiatedFormat& format = device->capture.format();
    Size eye;
    if (!eye_size(options_.layout, {format.width_px, format.height_px}, eye))
      return {Status::kUnsupported, device->capture.who() + " delivers " +
                                        size_text(format.width_px, format.height_px) + ", which the layout " +
                                        to_string(options_.layout) + " cannot divide"};
    if (eye_.width_px == 0) eye_ = eye;
    if (eye.width_px != eye_.width_px || eye.height_px != eye_.height_px)
      return {Status::kUnsupported, device->capture.who() + " delivers " + size_text(eye.width_px, eye.height_px) +
                                        " an eye instead of " + size_text(eye_.width_px, eye_.height_px) +
                                        ": give the size"};
  }
  if (eye_.width_px > kMaxImageSide_px || eye_.height_px > kMaxImageSide_px)
    return {Status::kCapacityExceeded, "an eye of " + size_text(eye_.width_px, eye_.height_px) + " pixels: at most " +
                                           size_text(kMaxImageSide_px, kMaxImageSide_px) + " are possible"};
  if (!options_.calibration.empty() && rig_.left.width_px == 0)
    for (Camera* camera : {&rig_.left, &rig_.right}) {
      camera->width_px = eye_.width_px;
      camera->height_px = eye_.height_px;
    }
  return {};
}

}  // namespace accrete::hal::v4l2
