// Exposure, gain and white balance of a camera: stored, and without effect on the images.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "descriptors.h"

namespace accrete::vm {

// Requests of the video class.
enum class Ask : std::uint8_t {
  kSetCurrent = 0x01,
  kCurrent = 0x81,
  kLeast = 0x82,
  kMost = 0x83,
  kStep = 0x84,
  kLength = 0x85,
  kInfo = 0x86,
  kDefault = 0x87,
};

class Controls {
 public:
  // Answers a request for control `selector` of an entity; `given` comes with kSetCurrent. False: there is none.
  [[nodiscard]] bool answer(std::uint8_t entity, std::uint8_t selector, Ask ask, std::span<const std::uint8_t> given,
                            Bytes& reply);

 private:
  struct Control {
    std::uint8_t entity, selector;
    int bytes;
    std::uint32_t least, most, step, initial, current;
  };
  std::array<Control, 6> controls_{{
      {kCameraTerminal, 0x02, 1, 0, 0, 0x09, 8, 8},           // exposure mode: the step lists 1 manual, 8 automatic
      {kCameraTerminal, 0x04, 4, 1, 5000, 1, 157, 157},       // exposure time, 0.1 ms
      {kProcessingUnit, 0x02, 2, 0, 255, 1, 128, 128},        // brightness
      {kProcessingUnit, 0x04, 2, 0, 100, 1, 20, 20},          // gain
      {kProcessingUnit, 0x0a, 2, 2800, 6500, 1, 4600, 4600},  // white balance, K
      {kProcessingUnit, 0x0b, 1, 0, 1, 1, 1, 1},              // white balance, automatic
  }};
};

}  // namespace accrete::vm
