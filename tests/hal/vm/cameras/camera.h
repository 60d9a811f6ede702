// One software camera: answers the kernel's requests, and plays its pictures while somebody streams.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>

#include "controls.h"
#include "pictures.h"
#include "usb_link.h"

namespace accrete::vm {

// CLOCK_MONOTONIC.
[[nodiscard]] std::int64_t now_ns();

// What all cameras show, so that their pictures belong together.
struct Playback {
  std::int64_t epoch_ns = 0;  // of tick 0
  std::int64_t period_ns = 0;
  bool held = false;         // the reader paces: picture `number` again and again, both cameras together (begin());
                             // otherwise one picture a tick, each camera by the clock
  std::uint64_t number = 0;  // of the picture at tick 0
};

// What is to go wrong, counted down frame by frame.
struct Faults {
  int drop = 0;                     // frames that are not sent
  int cut = 0;                      // frames of which the second half is not sent
  int flag = 0;                     // frames with the error bit
  std::int64_t still_until_ns = 0;  // nothing is sent before
  std::int64_t late_ns = 0;         // every frame
};

class Camera {
 public:
  Camera(int number, const Pictures& pictures, const Playback& playback, std::uint32_t rate_hz)
      : number_(number), pictures_(pictures), playback_(playback), rate_hz_(rate_hz) {}

  void plug() { link_ = std::make_unique<UsbLink>(number_); }
  void unplug();
  [[nodiscard]] int descriptor() const { return link_ ? link_->descriptor() : -1; }
  // Answers one request, waiting for it. A controller that is gone unplugs the camera.
  void serve();
  [[nodiscard]] bool streams() const { return link_ && streaming_; }
  // Has nothing to send, and could.
  [[nodiscard]] bool ready() const { return !in_frame_ && !pending_.empty(); }
  // Playback is held: now. Precondition: streams() and ready().
  void begin() { (void)begin_frame(0); }
  // Sends one payload if there is one to send. Returns how long nothing will be, in ns.
  [[nodiscard]] std::int64_t send();

  Faults faults;

 private:
  [[nodiscard]] bool answer(const UsbRequest& request);
  [[nodiscard]] bool control(const UsbRequest& request, Bytes& reply);
  [[nodiscard]] bool video_control(const UsbRequest& request, Bytes& reply);
  [[nodiscard]] bool begin_frame(std::int64_t tick);
  [[nodiscard]] std::int64_t last_tick(std::int64_t now) const;

  struct Pending {  // a request for stream data
    std::uint32_t sequence, length;
  };

  int number_;
  const Pictures& pictures_;
  const Playback& playback_;
  std::uint32_t rate_hz_;
  std::unique_ptr<UsbLink> link_;
  Controls controls_;
  std::deque<Pending> pending_;
  std::uint32_t newest_ = 0;                          // sequence of the newest request
  std::map<std::uint32_t, std::uint32_t> overtaken_;  // given up before they came; with the sequence of what says so

  bool streaming_ = false;
  std::size_t format_ = 0;   // of pictures_.formats()
  std::int64_t due_ns_ = 0;  // ticks before were sent already
  Bytes frame_;
  std::size_t sent_ = 0;  // bytes of frame_
  bool in_frame_ = false, flagged_ = false;
  std::uint8_t toggle_ = 0;  // the bit by which the host tells frames apart
};

}  // namespace accrete::vm
