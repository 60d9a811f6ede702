// One streaming device: from its node to images with a time and a number. Whatever fails, close() leaves nothing
// behind.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "camera/arrivals.h"
#include "v4l2/buffers.h"
#include "v4l2/negotiate.h"

namespace accrete::hal::v4l2 {

class Capture {
 public:
  explicit Capture(Kernel& kernel) : kernel_(kernel), buffers_(kernel) {}
  ~Capture() { close(); }
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;

  // Opens the node and asks what it is. Status: kNotFound, kUnavailable (busy, forbidden), kUnsupported (no camera).
  [[nodiscard]] Outcome open(const std::string& node);
  [[nodiscard]] Outcome negotiate(const FormatRequest& request);
  // Buffers, mapped and handed to the driver; then the stream. Two steps, so that two devices start together.
  [[nodiscard]] Outcome prepare(int buffers);
  [[nodiscard]] Outcome stream_on();
  void stop();
  void close();

  enum class Took : std::uint8_t {
    kImage,
    kNothing,  // none is ready
    kDamaged,  // one that is of no use; it went back already
    kLost,     // the device is gone or has given up: close() and open() it again; loss() says why
  };
  struct Image {
    int slot = -1;
    std::int64_t t_ns = 0;
    std::uint64_t sequence = 0;  // of the driver, continued beyond 32 bits; from 0 at every stream_on()
  };
  // `revents`: what poll() said, where it did.
  [[nodiscard]] Took take(short revents, Image& image);
  void give_back(int slot);
  // What lies in a slot that was taken, valid until it is given back.
  [[nodiscard]] RawImage raw(int slot) const;

  [[nodiscard]] bool is_open() const { return fd_ >= 0; }
  [[nodiscard]] bool streaming() const { return streaming_; }
  [[nodiscard]] int fd() const { return fd_; }
  [[nodiscard]] int buffers() const { return buffers_.count(); }
  [[nodiscard]] const Capability& capability() const { return capability_; }
  [[nodiscard]] const NegotiatedFormat& format() const { return format_; }
  [[nodiscard]] const std::string& loss() const { return loss_; }
  // "/dev/video0 (card)"
  [[nodiscard]] std::string who() const;
  // Counts of the stream, and what it says about itself. They go on over a reconnection.
  LiveDeviceStatistics statistics;

 private:
  struct Slot {
    bool with_driver = false;
    std::array<std::size_t, 3> begin{}, end{};  // bytes of the image in each plane
  };

  [[nodiscard]] std::uint32_t type() const;
  [[nodiscard]] bool queue(int slot);
  [[nodiscard]] bool queue_owed();
  Took lose(const std::string& why);
  Took discard(int slot);
  [[nodiscard]] bool stamp(std::uint32_t flags, std::int64_t stamp_ns, Image& image);

  Kernel& kernel_;
  Buffers buffers_;
  std::string node_, loss_;
  Capability capability_;
  NegotiatedFormat format_;
  int fd_ = -1;
  bool streaming_ = false;
  std::vector<Slot> slots_;
  std::vector<int> owed_;  // given back, but the driver did not take them yet
  int refusals_ = 0;       // of give-backs, in a row
  camera::Arrivals arrivals_;
};

}  // namespace accrete::hal::v4l2
