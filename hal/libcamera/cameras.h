// What the source needs of libcamera, in words of its own: cameras.cpp alone includes libcamera's headers, and a test
// can stand in its place.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "accrete/hal/libcamera.h"
#include "camera/convert.h"
#include "camera/eyes.h"
#include "libcamera/mailbox.h"

namespace accrete::hal::libcam {

struct KnownFormat {
  const char* name;  // libcamera's
  const char* v4l2;  // what V4L2 calls it
  camera::RawFormat raw;
};
// In the order in which one is chosen, as V4L2's: colour before grey, no conversion before conversion, no compression
// before compression.
[[nodiscard]] std::span<const KnownFormat> known_formats();
// By either name.
[[nodiscard]] const KnownFormat* find_format(std::string_view name);
[[nodiscard]] bool understood(const KnownFormat& format);

struct Negotiated {
  const KnownFormat* known = nullptr;
  camera::Size size;
  int buffers = 0;
};

// One camera, acquired. The destructor gives everything back, whatever has happened before.
class Device {
 public:
  virtual ~Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  // Names that the camera lists.
  [[nodiscard]] virtual std::vector<std::string> formats() const = 0;
  // Buffers are allocated. `size` 0: the camera's choice. kUnsupported: it cannot, and what it can.
  [[nodiscard]] virtual Outcome configure(const KnownFormat& format, camera::Size size, int buffers,
                                          Negotiated& negotiated) = 0;

  [[nodiscard]] virtual bool has_control(const std::string& name) const = 0;
  // kInvalidArgument: no such control, or a value that it does not take, with what it takes.
  [[nodiscard]] virtual Outcome check(const LibcameraControl& control) const = 0;
  // In force some images later. Precondition: check().
  virtual void set(const std::vector<LibcameraControl>& controls) = 0;
  // What the camera said with its last image, of these names; others are left out.
  [[nodiscard]] virtual std::vector<LibcameraControl> reported(const std::vector<std::string>& names) const = 0;

  // Images go to `mailbox`, from another thread, until stop() returns.
  [[nodiscard]] virtual Outcome start(camera::Eye eye, Mailbox& mailbox) = 0;
  virtual void stop() = 0;
  virtual void give_back(int slot) = 0;
  // What lies in a slot that came with a letter, until it is given back.
  [[nodiscard]] virtual camera::RawImage raw(int slot) const = 0;

 protected:
  Device() = default;
};

// libcamera's camera manager, from start() to stop().
class Cameras {
 public:
  virtual ~Cameras() = default;
  Cameras(const Cameras&) = delete;
  Cameras& operator=(const Cameras&) = delete;

  // Again each time after stop(): what is plugged in is looked for then.
  [[nodiscard]] virtual Outcome start() = 0;
  virtual void stop() = 0;  // every device is gone before
  // In libcamera's order.
  [[nodiscard]] virtual std::vector<LibcameraCamera> list() const = 0;
  [[nodiscard]] virtual Outcome open(const std::string& id, std::unique_ptr<Device>& device) = 0;

 protected:
  Cameras() = default;
};

[[nodiscard]] std::unique_ptr<Cameras> make_cameras();
[[nodiscard]] std::string version();

}  // namespace accrete::hal::libcam
