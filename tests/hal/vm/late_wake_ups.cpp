// To be preloaded: the race in libcamera that deep_call.h is about, always lost. libcamera's thread notifies a
// semaphore after letting it go; here the caller comes late enough never to wait, and the notification when the caller
// is long gone. At the end it says how many came, and how many of them into memory that held something else by then.
#include <dlfcn.h>
#include <pthread.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

namespace {

constexpr std::chrono::milliseconds kCallerComes{60}, kNotified{120};
constexpr std::size_t kWaiters = 36;  // byte of glibc's condition variable that changes when it is destroyed

using Bytes = std::array<unsigned char, sizeof(pthread_cond_t)>;

std::mutex mutex;
std::map<const void*, std::optional<Bytes>> left;  // of semaphores: what was there when its caller went; none: waits
std::atomic<int> late{0}, reused{0};
thread_local const void* releasing = nullptr;
// Where the condition variable is in a semaphore: behind the mutex.
constexpr std::size_t kCondition = sizeof(pthread_mutex_t);

Bytes bytes_at(const void* place) {
  Bytes bytes;
  std::memcpy(bytes.data(), place, bytes.size());
  bytes[kWaiters] &= 0xFB;  // destroyed
  return bytes;
}

template <class Function>
Function next(const char* name) {
  void* found = dlsym(RTLD_NEXT, name);
  if (found == nullptr) {
    std::fprintf(stderr, "late wake-ups: no %s\n", name);
    std::abort();
  }
  return reinterpret_cast<Function>(found);
}

struct Summary {
  ~Summary() { std::fprintf(stderr, "late wake-ups: %d, into memory in use again: %d\n", late.load(), reused.load()); }
} const summary;

}  // namespace

namespace libcamera {
class Semaphore {
 public:
  void acquire(unsigned n);
  void release(unsigned n);
};

void Semaphore::acquire(unsigned n) {
  static const auto real = next<void (*)(Semaphore*, unsigned)>("_ZN9libcamera9Semaphore7acquireEj");
  {
    const std::lock_guard lock(mutex);
    left[this] = std::nullopt;
  }
  std::this_thread::sleep_for(kCallerComes);
  real(this, n);
  const std::lock_guard lock(mutex);
  left[this] = bytes_at(reinterpret_cast<const char*>(this) + kCondition);
}

void Semaphore::release(unsigned n) {
  static const auto real = next<void (*)(Semaphore*, unsigned)>("_ZN9libcamera9Semaphore7releaseEj");
  releasing = this;
  real(this, n);
  releasing = nullptr;
}
}  // namespace libcamera

extern "C" int pthread_cond_broadcast(pthread_cond_t* condition) {
  static const auto real = next<int (*)(pthread_cond_t*)>("pthread_cond_broadcast");
  if (releasing != nullptr) {
    std::this_thread::sleep_for(kNotified);
    const std::lock_guard lock(mutex);
    if (const auto found = left.find(releasing); found != left.end() && found->second) {
      ++late;
      if (bytes_at(condition) != *found->second) {
        ++reused;
        return 0;  // it would do what it does
      }
    }
  }
  return real(condition);
}
