// Which left image belongs to which right one: by time alone, never by counting.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace accrete::hal::camera {

enum class Eye : std::uint8_t { kLeft, kRight };

// An image that waits for its partner: where it lies, when it was taken.
struct Waiting {
  int slot = -1;
  std::int64_t t_ns = 0;
  std::uint64_t sequence = 0;
};

struct Pair {
  Waiting left, right;
};

// From b to a. Times may wrap, as 64-bit nanoseconds and in tests do: the difference does not mind.
[[nodiscard]] constexpr std::int64_t time_difference(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}

class Pairer {
 public:
  // At most `depth` images of an eye wait. A camera whose images arrive late by up to that many periods loses none.
  Pairer(std::int64_t tolerance_ns, int depth);

  // Precondition: later than the last one of this eye (that is checked where images are taken).
  void add(Eye eye, const Waiting& image);
  // The next pair: no further apart than the tolerance, and neither has a nearer partner among those that wait.
  [[nodiscard]] bool next(Pair& pair);
  // Images that will find no partner, since the last call: the caller gives their slots back.
  [[nodiscard]] std::vector<Waiting>& unpaired(Eye eye) { return unpaired_[index(eye)]; }
  // Those that still wait.
  [[nodiscard]] std::vector<Waiting>& waiting(Eye eye) { return waiting_[index(eye)]; }
  // The smallest distance between images of the two eyes that were no pair, negative: none yet. For the message.
  [[nodiscard]] std::int64_t nearest_miss_ns() const { return nearest_miss_ns_; }
  void clear();

 private:
  static std::size_t index(Eye eye) { return static_cast<std::size_t>(eye); }
  void give_up_oldest(Eye eye);

  std::int64_t tolerance_ns_;
  std::size_t depth_;
  std::array<std::vector<Waiting>, 2> waiting_, unpaired_;  // few: erasing the first costs nothing
  std::int64_t nearest_miss_ns_ = -1;
};

}  // namespace accrete::hal::camera
