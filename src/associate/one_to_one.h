// From candidates to a one-to-one assignment, whatever the feature is (METHOD 6.3, 6.4): the nearest candidates, the
// few best hypotheses of each expected feature, the guard against ambiguity, and the greedy choice.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace accrete::associate {

inline constexpr std::int32_t kNone = -1;

enum class AssociateOutcome : std::uint8_t {
  kMissed,     // nothing in its gate
  kStereo,     // both eyes
  kMono,       // one eye
  kAmbiguous,  // two structures fit about equally well: no evidence either way
  kStarved,    // its observation belongs to a neighbour on the same structure: no evidence either way
};

struct Association {
  AssociateOutcome outcome = AssociateOutcome::kMissed;
  std::int32_t left = kNone, right = kNone;
  // Which of its equivalent descriptions fits: 0 as it is, of an edge 1 the reversed one.
  std::uint8_t left_sense = 0, right_sense = 0;
  float log_likelihood_ratio = 0;  // IPDA bracket of METHOD 7.2 for both eyes; not clipped
  float d2 = 0;  // squared geometric innovation of a match, of an edge: 4 degrees of freedom, 2 of one eye
};

struct Hypothesis {
  float gain;  // log likelihood ratio over that of a miss
  float log_likelihood_ratio;
  std::uint32_t expected;
  std::int32_t left, right;
  std::uint8_t left_sense, right_sense;
  float d2;
};
inline constexpr std::size_t kPerExpected = 4;

inline constexpr float kLogThree = 1.0986F;  // METHOD 6.4: the margin below which two structures are ambiguous

// The nearest candidates of one eye: those with the smallest d2.
template <class Candidate>
struct NearestList {
  static constexpr std::size_t kMax = 8;
  std::array<Candidate, kMax> item;
  std::size_t count = 0;

  void offer(const Candidate& c) {
    if (count < kMax) {
      item[count++] = c;
      return;
    }
    auto worst =
        std::max_element(item.begin(), item.end(), [](const Candidate& a, const Candidate& b) { return a.d2 < b.d2; });
    if (c.d2 < worst->d2) *worst = c;
  }
};

// The best hypotheses of one expected feature, best first.
class HypothesisList {
 public:
  void clear() { count_ = 0; }
  void offer(const Hypothesis& h) {
    if (count_ == item_.size() && h.gain <= item_[count_ - 1].gain) return;
    std::size_t at = std::min(count_, item_.size() - 1);
    for (; at > 0 && item_[at - 1].gain < h.gain; --at) item_[at] = item_[at - 1];
    item_[at] = h;
    count_ = std::min(count_ + 1, item_.size());
  }
  [[nodiscard]] std::span<const Hypothesis> items() const { return std::span(item_).first(count_); }

  // Is the best one about as good as one of a different structure? different(best, other).
  template <class Different>
  [[nodiscard]] bool is_ambiguous(Different different) const {
    bool ambiguous = false;
    for (std::size_t k = 1; k < count_ && item_[k].gain > item_[0].gain - kLogThree; ++k)
      ambiguous = ambiguous || different(item_[0], item_[k]);
    return ambiguous;
  }

 private:
  std::array<Hypothesis, kPerExpected> item_;
  std::size_t count_ = 0;
};

// What a list says: nothing when it is ambiguous, otherwise its hypotheses that beat a miss, appended to the first `n`
// of `pool`. `association` becomes a miss until one of them is taken.
template <class Different>
void collect(const HypothesisList& list, float log_miss, Different different, Association& association,
             std::span<Hypothesis> pool, std::size_t& n) {
  association = {};
  association.log_likelihood_ratio = log_miss;
  if (list.is_ambiguous(different)) {
    association.outcome = AssociateOutcome::kAmbiguous;
    association.log_likelihood_ratio = 0;
    return;
  }
  for (const Hypothesis& h : list.items())
    if (h.gain > 0) pool[n++] = h;
}

// Greedy: where a wrong swap errs only along the edge, nothing is measured, and features that are points are apart
// (METHOD 6.3). Owners are kNone or an index of `out`. same(winner, loser): do the two expected features lie on one
// structure? Then losing an observation to the other says nothing about existence. `pool` is sorted.
template <class Same>
void assign_one_to_one(std::span<Hypothesis> pool, std::span<std::int32_t> left_owner,
                       std::span<std::int32_t> right_owner, std::span<Association> out, Same same) {
  std::sort(pool.begin(), pool.end(), [](const Hypothesis& a, const Hypothesis& b) {
    if (a.gain != b.gain) return a.gain > b.gain;
    if (a.expected != b.expected) return a.expected < b.expected;
    return a.left != b.left ? a.left < b.left : a.right < b.right;
  });
  for (const Hypothesis& h : pool) {
    Association& a = out[h.expected];
    if (a.outcome == AssociateOutcome::kStereo || a.outcome == AssociateOutcome::kMono) continue;
    std::int32_t* owner_l = h.left == kNone ? nullptr : &left_owner[static_cast<std::size_t>(h.left)];
    std::int32_t* owner_r = h.right == kNone ? nullptr : &right_owner[static_cast<std::size_t>(h.right)];
    const std::int32_t taken_l = owner_l == nullptr ? kNone : *owner_l;
    const std::int32_t taken_r = owner_r == nullptr ? kNone : *owner_r;
    if (taken_l == kNone && taken_r == kNone) {
      a = {owner_l != nullptr && owner_r != nullptr ? AssociateOutcome::kStereo : AssociateOutcome::kMono,
           h.left,
           h.right,
           h.left_sense,
           h.right_sense,
           h.log_likelihood_ratio,
           h.d2};
      if (owner_l != nullptr) *owner_l = static_cast<std::int32_t>(h.expected);
      if (owner_r != nullptr) *owner_r = static_cast<std::int32_t>(h.expected);
      continue;
    }
    const std::int32_t winner = taken_l != kNone ? taken_l : taken_r;
    if (same(static_cast<std::uint32_t>(winner), h.expected)) {
      a.outcome = AssociateOutcome::kStarved;
      a.log_likelihood_ratio = 0;
    }
  }
}

}  // namespace accrete::associate
