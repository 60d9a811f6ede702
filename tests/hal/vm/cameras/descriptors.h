// What a camera says of itself over USB: the standard and the USB Video Class 1.0 descriptors, and the negotiation of a
// stream.
#pragma once

#include <cstdint>
#include <vector>

#include "pictures.h"

namespace accrete::vm {

using Bytes = std::vector<std::uint8_t>;

// Little-endian, as USB has it.
void put(Bytes& to, std::uint32_t value, int bytes);

// Entities of the control interface, which the requests for controls name.
inline constexpr std::uint8_t kCameraTerminal = 1, kProcessingUnit = 2;
// A payload that is one request of the host: uvcvideo asks for 32 packets of 512 bytes at once.
inline constexpr std::uint32_t kPayloadBytes = 16384;

[[nodiscard]] Bytes device_descriptor();
[[nodiscard]] Bytes qualifier_descriptor();
// Two interfaces: control, and a stream over a bulk endpoint (vhci_hcd's isochronous transfers have no rate).
[[nodiscard]] Bytes configuration_descriptor(const Pictures& pictures, std::uint32_t rate_hz);
// 0: the languages; 1: maker, 2: product, 3: serial number.
[[nodiscard]] Bytes string_descriptor(std::uint8_t index, int camera);
// The camera's proposal for a stream in pictures.formats()[format].
[[nodiscard]] Bytes stream_proposal(const Pictures& pictures, std::size_t format, std::uint32_t rate_hz);

}  // namespace accrete::vm
