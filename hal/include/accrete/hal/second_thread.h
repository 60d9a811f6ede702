// A thread that waits until a step hands it the right image.
#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

#include "accrete/pair_runner.h"

namespace accrete::hal {

// It has the priority and the cores of the thread that makes it. For one Accumulator at a time, and until its last step
// has ended. Waits without using the processor; a step that wakes it costs some microseconds.
class SecondThread {
 public:
  SecondThread();
  ~SecondThread();
  SecondThread(const SecondThread&) = delete;
  SecondThread& operator=(const SecondThread&) = delete;

  // False where the system has no thread to give.
  [[nodiscard]] bool available() const { return thread_.joinable(); }
  // For Accumulator::set_pair_runner; {} where there is no thread: a step then does everything itself.
  [[nodiscard]] PairRunner runner() { return available() ? PairRunner{&SecondThread::run, this} : PairRunner{}; }

 private:
  using Task = void (*)(void* argument, int which);

  static void run(void* context, Task task, void* argument);
  void work();

  std::mutex mutex_;
  std::condition_variable changed_;
  Task task_ = nullptr;  // what is to be done; nullptr: nothing
  void* argument_ = nullptr;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace accrete::hal
