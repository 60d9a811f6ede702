// Failures of the environment, as values. A caller's bug goes to contract.h, an outcome that the mathematics expects
// (gated out, behind the camera, ...) is counted in a report: neither is a Status.
#pragma once

#include <cstdint>
#include <type_traits>

namespace accrete {

// Layout by hand: clang-format 14 misreads the attribute.
// clang-format off
enum class [[nodiscard]] Status : std::uint8_t {
  kOk,
  kInvalidArgument,   // a value that can never work: NaN in a calibration, a rotation that is none
  kCapacityExceeded,  // larger than the compile-time limits (limits.h)
  kNotFound,          // a file, a device or an entry that is not there
  kEndOfStream,       // the recording is finished
  kUnavailable,       // not in the state that the call needs, or not now
  kTimeout,           // nothing arrived in time
  kDataLoss,          // truncated or damaged data
  kUnsupported,       // understood, but not implemented
};
// clang-format on

// A short name for logs and messages: "ok", "invalid argument", ...
[[nodiscard]] constexpr const char* to_string(Status status) {
  switch (status) {
    case Status::kOk:
      return "ok";
    case Status::kInvalidArgument:
      return "invalid argument";
    case Status::kCapacityExceeded:
      return "capacity exceeded";
    case Status::kNotFound:
      return "not found";
    case Status::kEndOfStream:
      return "end of stream";
    case Status::kUnavailable:
      return "unavailable";
    case Status::kTimeout:
      return "timeout";
    case Status::kDataLoss:
      return "data loss";
    case Status::kUnsupported:
      return "unsupported";
  }
  return "unknown";
}

// A value or the reason why there is none. Small and trivially copyable by rule: larger results go through spans.
template <class T>
class [[nodiscard]] Result {
  static_assert(std::is_trivially_copyable_v<T>, "Result holds trivially copyable values only");

 public:
  constexpr Result(const T& value) : value_(value) {}   // NOLINT(google-explicit-constructor): a value is a result
  constexpr Result(Status status) : status_(status) {}  // NOLINT(google-explicit-constructor): and so is a failure

  [[nodiscard]] constexpr bool ok() const { return status_ == Status::kOk; }
  [[nodiscard]] constexpr Status status() const { return status_; }
  // Precondition: ok(). Without it the value is a default T.
  [[nodiscard]] constexpr const T& value() const { return value_; }

 private:
  T value_{};
  Status status_ = Status::kOk;
};

}  // namespace accrete
