// From options to opened devices with an agreed format.
#include <algorithm>

#include "text/sentence.h"
#include "v4l2/enumerate.h"
#include "v4l2/source.h"

namespace accrete::hal::v4l2 {

Outcome Source::check_format() const {
  const LiveOptions& o = options();
  const KnownFormat* known = o.format.empty() ? nullptr : find_format(o.format);
  if (!o.format.empty() && (known == nullptr || !understood(*known))) {
    std::string names;
    for (const KnownFormat& format : known_formats())
      if (understood(format)) names += (names.empty() ? "" : ", ") + std::string(format.name);
    return {Status::kUnsupported, "the format " + in_quotes(o.format) + " is not understood; understood are " + names};
  }
  if (known != nullptr && (known->raw == RawFormat::kY8i) != (o.layout == StereoLayout::kInterleaved))
    return {Status::kInvalidArgument, std::string("the format ") + known->name + " does not fit the layout " +
                                          to_string(o.layout) + ": Y8I belongs to y8i, and to no other"};
  return {};
}

Outcome Source::configure_devices() {
  if (Outcome o = check_format(); !o.ok()) return o;
  std::string left, right;
  if (Outcome o = find_node(kernel_, options().left, left); !o.ok()) return o;
  if (two()) {
    if (Outcome o = find_node(kernel_, options().right, right); !o.ok()) return o;
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
  return negotiate_all();
}

// Formats that may serve, the best first: those that all devices list.
std::vector<const KnownFormat*> Source::candidates() {
  std::vector<const KnownFormat*> result;
  if (!options().format.empty()) return {find_format(options().format)};
  std::vector<std::vector<V4l2Format>> lists;
  for (Device* device : devices())
    lists.push_back(enumerate_formats(kernel_, device->capture.fd(), device->capture.capability().multiplanar, false));
  for (const KnownFormat& known : known_formats()) {
    if (!understood(known) || (known.raw == RawFormat::kY8i) != (options().layout == StereoLayout::kInterleaved))
      continue;
    const bool everywhere = std::all_of(lists.begin(), lists.end(), [&known](const std::vector<V4l2Format>& list) {
      return std::any_of(list.begin(), list.end(),
                         [&known](const V4l2Format& format) { return format.fourcc == known.name; });
    });
    if (everywhere) result.push_back(&known);
  }
  return result;
}

Outcome Source::negotiate_with(const KnownFormat* known) {
  const Size buffer = buffer_size(options().layout, wanted_size());
  for (Device* device : devices())
    if (Outcome o = device->capture.negotiate({known, buffer.width_px, buffer.height_px, options().rate_hz}); !o.ok())
      return o;
  return {};
}

Outcome Source::negotiate_all() {
  const std::vector<const KnownFormat*> formats = candidates();
  if (formats.empty()) {  // a driver that lists nothing: what it is set to
    if (Outcome o = negotiate_with(nullptr); !o.ok()) return o;
    if ((left_.capture.format().known->raw == RawFormat::kY8i) == (options().layout == StereoLayout::kInterleaved))
      return {};
    return {Status::kUnsupported, left_.capture.who() + " has no format for the layout " + to_string(options().layout)};
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
    if (options().rate_hz == 0 || rate == 0 || rate > 0.95 * options().rate_hz) return {};
    if (slow == nullptr) slow = known;
  }
  return slow != nullptr ? negotiate_with(slow) : failure;
}

}  // namespace accrete::hal::v4l2
