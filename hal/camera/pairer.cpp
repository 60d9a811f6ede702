#include "camera/pairer.h"

#include <algorithm>

namespace accrete::hal::camera {
namespace {

std::uint64_t distance(std::int64_t a, std::int64_t b) {
  const std::int64_t d = time_difference(a, b);
  return d < 0 ? 0 - static_cast<std::uint64_t>(d) : static_cast<std::uint64_t>(d);
}

}  // namespace

Pairer::Pairer(std::int64_t tolerance_ns, int depth)
    : tolerance_ns_(tolerance_ns), depth_(static_cast<std::size_t>(std::max(depth, 1))) {
  for (auto* list : {&waiting_, &unpaired_})
    for (auto& eye : *list) eye.reserve(2 * depth_ + 2);
}

void Pairer::give_up_oldest(Eye eye) {
  auto& waiting = waiting_[index(eye)];
  unpaired_[index(eye)].push_back(waiting.front());
  waiting.erase(waiting.begin());
}

void Pairer::add(Eye eye, const Waiting& image) {
  waiting_[index(eye)].push_back(image);
  if (waiting_[index(eye)].size() > depth_) give_up_oldest(eye);
}

bool Pairer::next(Pair& pair) {
  auto& left = waiting_[index(Eye::kLeft)];
  auto& right = waiting_[index(Eye::kRight)];
  while (!left.empty() && !right.empty()) {
    const std::int64_t ahead = time_difference(right.front().t_ns, left.front().t_ns);
    const std::uint64_t apart = distance(right.front().t_ns, left.front().t_ns);
    const Eye earlier = ahead > 0 ? Eye::kLeft : Eye::kRight;
    const auto& its = earlier == Eye::kLeft ? left : right;
    const std::int64_t partner = earlier == Eye::kLeft ? right.front().t_ns : left.front().t_ns;
    const bool nearer_follows = its.size() > 1 && distance(its[1].t_ns, partner) < apart;
    if (apart <= static_cast<std::uint64_t>(tolerance_ns_) && !nearer_follows) {
      pair = {left.front(), right.front()};
      left.erase(left.begin());
      right.erase(right.begin());
      return true;
    }
    if (apart > static_cast<std::uint64_t>(tolerance_ns_)) {
      const auto miss = static_cast<std::int64_t>(std::min<std::uint64_t>(apart, INT64_MAX));
      nearest_miss_ns_ = nearest_miss_ns_ < 0 ? miss : std::min(nearest_miss_ns_, miss);
    }
    give_up_oldest(earlier);
  }
  return false;
}

void Pairer::clear() {
  for (auto& eye : waiting_) eye.clear();
  for (auto& eye : unpaired_) eye.clear();
  nearest_miss_ns_ = -1;
}

}  // namespace accrete::hal::camera
