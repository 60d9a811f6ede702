#include "descriptors.h"

#include <string>

namespace accrete::vm {
namespace {

void append(Bytes& to, const Bytes& more) { to.insert(to.end(), more.begin(), more.end()); }

// The length comes first in every descriptor.
Bytes descriptor(Bytes rest) {
  rest.insert(rest.begin(), static_cast<std::uint8_t>(rest.size() + 1));
  return rest;
}

std::uint32_t interval_100ns(std::uint32_t rate_hz) { return 10'000'000 / rate_hz; }

// The rest of the 16 bytes is the same for every FOURCC of the video class; BGR has an identifier of its own.
Bytes guid(Format format) {
  if (format == Format::kBgr)
    return {0x7d, 0xeb, 0x36, 0xe4, 0x4f, 0x52, 0xce, 0x11, 0x9f, 0x53, 0x00, 0x20, 0xaf, 0x0b, 0xa7, 0x70};
  Bytes id = format == Format::kYuyv ? Bytes{'Y', 'U', 'Y', '2'} : Bytes{'Y', '8', '0', '0'};
  append(id, {0x00, 0x00, 0x10, 0x00, 0x80, 0x00, 0x00, 0xaa, 0x00, 0x38, 0x9b, 0x71});
  return id;
}

// A format of one size and one rate.
Bytes format_descriptors(const Pictures& pictures, std::size_t index, std::uint32_t rate_hz) {
  const Format format = pictures.formats()[index];
  const bool jpeg = format == Format::kMjpg;
  const auto number = static_cast<std::uint8_t>(index + 1);
  const auto frame_bytes = static_cast<std::uint32_t>(pictures.frame_bytes(format));
  Bytes head{0x24, static_cast<std::uint8_t>(jpeg ? 6 : 4), number, 1};  // one frame descriptor follows
  if (jpeg) {
    append(head, {1, 1, 0, 0, 0, 0});  // samples of fixed size, default frame 1, no aspect ratio, no interlacing, copy
  } else {
    append(head, guid(format));
    const int bits = format == Format::kGrey ? 8 : format == Format::kYuyv ? 16 : 24;
    append(head, {static_cast<std::uint8_t>(bits), 1, 0, 0, 0, 0});
  }
  Bytes frame{0x24, static_cast<std::uint8_t>(jpeg ? 7 : 5), 1, 0};
  put(frame, static_cast<std::uint32_t>(pictures.width_px()), 2);
  put(frame, static_cast<std::uint32_t>(pictures.height_px()), 2);
  put(frame, frame_bytes * 8 * rate_hz, 4);  // bits a second, least and most
  put(frame, frame_bytes * 8 * rate_hz, 4);
  put(frame, frame_bytes, 4);
  put(frame, interval_100ns(rate_hz), 4);
  put(frame, 1, 1);  // one interval
  put(frame, interval_100ns(rate_hz), 4);
  Bytes all = descriptor(head);
  append(all, descriptor(frame));
  if (!jpeg) append(all, descriptor({0x24, 0x0d, 1, 1, 4}));  // colours as in BT.709, BT.601's matrix
  return all;
}

Bytes control_interface() {
  Bytes units = descriptor({0x24, 2, kCameraTerminal, 0x01, 0x02, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0x0a, 0,
                            0});  // controls: exposure mode (bit 1) and time (bit 3)
  append(units, descriptor({0x24, 5, kProcessingUnit, kCameraTerminal, 0, 0, 2, 0x41, 0x12,
                            0}));  // brightness 0, white balance 6, gain 9, automatic white balance 12
  append(units, descriptor({0x24, 3, 3, 0x01, 0x01, 0, kProcessingUnit, 0}));  // the terminal towards USB
  Bytes header{0x24, 1};
  put(header, 0x0100, 2);  // version 1.0
  put(header, static_cast<std::uint32_t>(13 + units.size()), 2);
  put(header, 1'000'000, 4);  // Hz, of a clock that nobody uses
  put(header, 1, 1);          // streams: interface 1
  put(header, 1, 1);
  Bytes all = descriptor({4, 0, 0, 0, 0x0e, 1, 0, 0});
  append(all, descriptor(header));
  append(all, units);
  return all;
}

Bytes streaming_interface(const Pictures& pictures, std::uint32_t rate_hz) {
  const std::size_t count = pictures.formats().size();
  Bytes formats;
  for (std::size_t i = 0; i < count; ++i) append(formats, format_descriptors(pictures, i, rate_hz));
  Bytes header{0x24, 1, static_cast<std::uint8_t>(count)};
  put(header, static_cast<std::uint32_t>(13 + count + formats.size()), 2);
  append(header, {0x81, 0, 3, 0, 0, 0, 1});  // endpoint 1 in; towards terminal 3; no still images
  header.resize(header.size() + count);      // and no controls of a format
  Bytes all = descriptor({4, 1, 0, 1, 0x0e, 2, 0, 0});
  append(all, descriptor(header));
  append(all, formats);
  append(all, descriptor({5, 0x81, 2, 0x00, 0x02, 0}));  // bulk, 512 bytes
  return all;
}

}  // namespace

void put(Bytes& to, std::uint32_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) to.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

// USB 2.0, class "miscellaneous, with interface associations", 64 bytes a packet of endpoint 0, 1d6b:0102 (Linux
// Foundation, a gadget of video).
Bytes device_descriptor() {
  return descriptor({1, 0x00, 0x02, 0xef, 2, 1, 64, 0x6b, 0x1d, 0x02, 0x01, 0x00, 0x01, 1, 2, 3, 1});
}

Bytes qualifier_descriptor() { return descriptor({6, 0x00, 0x02, 0xef, 2, 1, 64, 1, 0}); }

Bytes configuration_descriptor(const Pictures& pictures, std::uint32_t rate_hz) {
  Bytes interfaces = descriptor({11, 0, 2, 0x0e, 3, 0, 0});  // the two belong together: a video device
  append(interfaces, control_interface());
  append(interfaces, streaming_interface(pictures, rate_hz));
  Bytes all{2};
  put(all, static_cast<std::uint32_t>(9 + interfaces.size()), 2);
  append(all, {2, 1, 0, 0x80, 250});  // two interfaces, configuration 1, powered by the bus, 500 mA
  all = descriptor(all);
  append(all, interfaces);
  return all;
}

Bytes string_descriptor(std::uint8_t index, int camera) {
  if (index == 0) return {4, 3, 0x09, 0x04};  // English
  const std::string text = index == 1   ? "accrete"
                           : index == 2 ? "Software camera " + std::to_string(camera)
                                        : "SN000" + std::to_string(camera);
  Bytes rest{3};
  for (const char c : text) put(rest, static_cast<std::uint8_t>(c), 2);  // UTF-16
  return descriptor(rest);
}

Bytes stream_proposal(const Pictures& pictures, std::size_t format, std::uint32_t rate_hz) {
  Bytes all;
  put(all, 0, 2);
  put(all, static_cast<std::uint32_t>(format + 1), 1);
  put(all, 1, 1);
  put(all, interval_100ns(rate_hz), 4);
  all.resize(18);  // compression: nothing to choose
  put(all, static_cast<std::uint32_t>(pictures.frame_bytes(pictures.formats()[format])), 4);
  put(all, kPayloadBytes, 4);
  return all;
}

}  // namespace accrete::vm
