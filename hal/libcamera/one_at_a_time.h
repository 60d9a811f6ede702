// A thing of which a process may have one at a time: everybody who wants it shares the one that there is, and a new one
// is made only once the last one is gone for good. (A weak_ptr expires before what it points to has ended: two threads
// that open and close would now and then have two.)
#pragma once

#include <memory>
#include <mutex>
#include <utility>

namespace accrete::hal::libcam {

template <class T>
class OneAtATime {
 public:
  // The one that there is, or what `make()` returns, a unique_ptr; null where that is null. Whoever comes while one is
  // made or ended waits. Every pointer counts, and may be copied and dropped in any thread.
  template <class Make>
  [[nodiscard]] std::shared_ptr<T> get(const Make& make) {
    T* it = nullptr;
    {
      const std::lock_guard lock(mutex_);
      if (!it_) it_ = make();
      if (!it_) return nullptr;
      ++users_;
      it = it_.get();
    }
    return {it, [this](T*) { leave(); }};
  }

 private:
  void leave() {
    const std::lock_guard lock(mutex_);
    if (--users_ == 0) it_.reset();
  }

  std::mutex mutex_;
  std::unique_ptr<T> it_;
  int users_ = 0;
};

}  // namespace accrete::hal::libcam
