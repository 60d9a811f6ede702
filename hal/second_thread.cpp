#include "accrete/hal/second_thread.h"

#include <system_error>

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

void SecondThread::run(void* context, Task task, void* argument) {
  auto& self = *static_cast<SecondThread*>(context);
  {
    const std::lock_guard lock(self.mutex_);
    self.task_ = task;
    self.argument_ = argument;
  }
  self.changed_.notify_all();
  task(argument, 0);
  std::unique_lock lock(self.mutex_);
  self.changed_.wait(lock, [&self] { return self.task_ == nullptr; });
}

void SecondThread::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return task_ != nullptr || ends_; });
    if (ends_) return;
    lock.unlock();
    task_(argument_, 1);
    lock.lock();
    task_ = nullptr;
    changed_.notify_all();  // with the lock: the step may end this object as soon as it has it
  }
}

}  // namespace accrete::hal
