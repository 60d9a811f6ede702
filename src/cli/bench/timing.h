// Times of many contenders in one run, interleaved: what disturbs the machine disturbs them all.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace accrete::cli {

struct Contender {
  std::string name;
  std::function<void()> prepare;  // before every run, not timed
  std::function<void()> run;
  double items = 1;  // that a run works on

  double median_ns = 0;  // per item: the least of the medians of five rounds
  double least_ns = 0;   // of all repetitions
};

// Seconds of processor time of this thread: what others use of a shared machine does not count.
[[nodiscard]] double thread_seconds();

// Five rounds of `repetitions` each, all contenders in a new order in every repetition. A repetition is two runs, of
// which the second is timed: the first finds caches full of what others work on.
void time_all(std::vector<Contender>& contenders, int repetitions);

}  // namespace accrete::cli
