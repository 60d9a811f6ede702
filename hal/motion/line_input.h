// Where live lines come from: standard input, a FIFO whose writers come and go, a UDP socket.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "accrete/hal/stereo_source.h"
#include "motion/line_splitter.h"

namespace accrete::hal {

class LineInput {
 public:
  // What the reading thread reports. Called from that thread alone.
  struct Listener {
    std::function<void(std::string_view)> line;
    std::function<void()> interrupted;  // a writer went away; another one may come
    std::function<void()> ended;        // nothing will come any more
  };

  LineInput() = default;
  ~LineInput();
  LineInput(const LineInput&) = delete;
  LineInput& operator=(const LineInput&) = delete;

  // Statuses of open_live_motion.
  Outcome open(const std::string& where);
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] int port() const { return port_; }

  // Reads until the stream ends or stop() is called; precondition: open.
  void run(const Listener& listener);
  // From any thread; run() returns within milliseconds.
  void stop();

 private:
  enum class Kind { kStandardInput, kFifo, kUdp };

  Outcome open_fifo(const std::string& path);
  Outcome open_udp(const std::string& address);
  // False when run() should return.
  bool wait();
  bool read_some(const Listener& listener);

  Kind kind_ = Kind::kStandardInput;
  std::string name_;
  int port_ = 0;
  int fd_ = -1;
  int wake_[2] = {-1, -1};  // a byte in this pipe ends run()
  bool no_writer_ = false;  // the FIFO's writer is gone
  LineSplitter splitter_;
  std::vector<char> buffer_;
};

}  // namespace accrete::hal
