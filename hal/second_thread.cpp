#include "accrete/hal/second_thread.h"

#include <system_error>
#include <utility>

namespace accrete::hal {

SecondThread::SecondThread() {
  try {
    thread_ = std::thread([this] { work(); });
  } catch (const std::system_error&) {  // available() says so
  }
}

SecondThread::~SecondThread() {
  if (!available()) return;
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void SecondThread::run_both(Task task, void* argument) {
  if (!available()) {
    task(argument, 0);
    task(argument, 1);
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    task_ = task;
    argument_ = argument;
  }
  changed_.notify_all();
  std::exception_ptr thrown;  // later: the other one still uses the argument
  try {
    task(argument, 0);
  } catch (...) {
    thrown = std::current_exception();
  }
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return task_ == nullptr; });
  const std::exception_ptr theirs = std::exchange(thrown_, nullptr);
  if (thrown) std::rethrow_exception(thrown);
  if (theirs) std::rethrow_exception(theirs);
}

void SecondThread::run(void* context, Task task, void* argument) {
  static_cast<SecondThread*>(context)->run_both(task, argument);
}

void SecondThread::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return task_ != nullptr || ends_; });
    if (ends_) return;
    lock.unlock();
    std::exception_ptr thrown;
    try {
      task_(argument_, 1);
    } catch (...) {
      thrown = std::current_exception();
    }
    lock.lock();
    thrown_ = thrown;
    task_ = nullptr;
    changed_.notify_all();  // with the lock: the step may end this object as soon as it has it
  }
}

}  // namespace accrete::hal
