// Which frames are kept aside, so that the model can be compared with images that it has never seen.
#pragma once

#include <cstdint>
#include <set>
#include <string>

namespace accrete::cli {

struct HoldOutPlan {
  int every = 0;
  std::set<std::uint64_t> held;    // compared: every N-th frame, beginning with number N - 1
  std::set<std::uint64_t> shared;  // not accumulated either: they show the left source photograph of one of those

  [[nodiscard]] bool keeps_aside(std::uint64_t frame) const { return held.contains(frame) || shared.contains(frame); }
};

// `sources`: the text of a recording's rig.txt, lines "frame left_source right_source ...", or empty; `name` stands for
// it in messages. Throws Failure(kInput) when it is garbled.
[[nodiscard]] HoldOutPlan plan_hold_out(int every, std::uint64_t frames, const std::string& sources,
                                        const std::string& name);

}  // namespace accrete::cli
