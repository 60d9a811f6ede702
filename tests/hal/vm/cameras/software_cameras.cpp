// software_cameras RECORDING RATE: two USB cameras that replay left/ and right/ of a plain recording, in a machine that
// has vhci_hcd. They obey orders.h and run until they are ended.
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>

#include "camera.h"
#include "orders.h"

namespace accrete::vm {
namespace {

class Rig {
 public:
  Rig(const std::filesystem::path& recording, std::uint32_t rate_hz)
      : pictures_{Pictures(recording / "left"), Pictures(recording / "right")},
        playback_{now_ns(), 1'000'000'000 / rate_hz},
        cameras_{Camera(0, pictures_[0], playback_, rate_hz), Camera(1, pictures_[1], playback_, rate_hz)} {
    sockaddr_un address{AF_UNIX, {}};
    std::strncpy(address.sun_path, kOrderSocket, sizeof address.sun_path - 1);
    unlink(kOrderSocket);
    orders_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (bind(orders_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0)
      throw std::runtime_error(std::string("cannot bind ") + kOrderSocket);
    for (Camera& camera : cameras_) camera.plug();
  }

  [[noreturn]] void run() {
    while (true) {
      std::int64_t wait = std::min<std::int64_t>(1'000'000'000, playback_.held ? begin_together() : kForever);
      for (Camera& camera : cameras_) wait = std::min(wait, camera.send());  // in turn: they keep step
      std::array<pollfd, 3> p{
          {{cameras_[0].descriptor(), POLLIN, 0}, {cameras_[1].descriptor(), POLLIN, 0}, {orders_, POLLIN, 0}}};
      const timespec t{wait / 1'000'000'000, wait % 1'000'000'000};
      if (ppoll(p.data(), p.size(), &t, nullptr) <= 0) continue;
      for (std::size_t i = 0; i < cameras_.size(); ++i)
        if (p[i].revents != 0) cameras_[i].serve();
      if (p[2].revents != 0) take_order();
    }
  }

 private:
  static constexpr std::int64_t kForever = std::numeric_limits<std::int64_t>::max();

  // All cameras that stream begin a picture together, however long the one before took: its times say then that left
  // and right belong together, and no machine is too slow. (Each by its own clock, a starved emulator loses nearly
  // every pair: a picture takes seconds, a test minutes.) Returns how long there is nothing to begin, in ns.
  std::int64_t begin_together() {
    const std::int64_t now = now_ns();
    if (now < next_ns_) return next_ns_ - now;
    for (const Camera& camera : cameras_)
      if (camera.streams() && !camera.ready()) return kForever;  // a request or a payload wakes this up again
    for (Camera& camera : cameras_)
      if (camera.streams()) camera.begin();
    next_ns_ = now + playback_.period_ns;
    return playback_.period_ns;
  }

  void take_order() {
    std::array<char, 128> line{};
    sockaddr_un from{};
    socklen_t size = sizeof from;
    if (recvfrom(orders_, line.data(), line.size() - 1, 0, reinterpret_cast<sockaddr*>(&from), &size) < 0) return;
    const std::string reply = obey(line.data()) ? "ok" : "no";
    sendto(orders_, reply.data(), reply.size(), MSG_DONTWAIT, reinterpret_cast<sockaddr*>(&from), size);
  }

  bool obey(const std::string& line) {
    std::istringstream words(line);
    std::string verb;
    std::uint64_t which = 0;
    int value = 0;
    words >> verb >> which >> value;
    if (verb == "show" || verb == "run") {
      next_ns_ = now_ns();
      playback_ = {next_ns_, playback_.period_ns, verb == "show", which};
      return true;
    }
    if (which >= cameras_.size()) return false;
    Camera& camera = cameras_[which];
    if (verb == "drop") return camera.faults.drop = value, true;
    if (verb == "cut") return camera.faults.cut = value, true;
    if (verb == "flag") return camera.faults.flag = value, true;
    if (verb == "still") return camera.faults.still_until_ns = now_ns() + value * std::int64_t{1'000'000}, true;
    if (verb == "late") return camera.faults.late_ns = value * std::int64_t{1'000'000}, true;
    if (verb == "unplug") return camera.unplug(), true;
    if (verb == "plug" && camera.descriptor() < 0) return camera.plug(), true;
    return false;
  }

  std::array<Pictures, 2> pictures_;
  Playback playback_;
  std::array<Camera, 2> cameras_;
  std::int64_t next_ns_ = 0;  // held: no picture begins before
  int orders_ = -1;
};

}  // namespace
}  // namespace accrete::vm

int main(int argc, char** argv) {
  try {
    if (argc != 3) throw std::runtime_error("usage: software_cameras RECORDING RATE");
    accrete::vm::Rig(argv[1], static_cast<std::uint32_t>(std::stoul(argv[2]))).run();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "software_cameras: %s\n", e.what());
    return 1;
  }
}
