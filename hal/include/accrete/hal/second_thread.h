// A thread for the right image, while the caller's does the left one.
#pragma once

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "accrete/pair_runner.h"

namespace accrete::hal {

// It has the priority and the cores of the thread that makes it, and waits without using a processor. For one caller at
// a time: an Accumulator that has it must end its last step before this ends.
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

  // task(argument, 0) here and task(argument, 1) there, or both here where there is no thread. Returns after both; what
  // one of them threw is thrown then.
  using Task = void (*)(void* argument, int which);
  void run_both(Task task, void* argument);

 private:
  static void run(void* context, Task task, void* argument);
  void work();

  std::mutex mutex_;
  std::condition_variable changed_;
  Task task_ = nullptr;  // what is to be done; nullptr: nothing
  void* argument_ = nullptr;
  std::exception_ptr thrown_;  // by the task in the thread
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace accrete::hal
