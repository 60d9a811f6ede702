#include "cli/bench/timing.h"

#include <algorithm>
#include <ctime>
#include <limits>
#include <numeric>
#include <random>

namespace accrete::cli {
namespace {

constexpr int kRounds = 5;

}  // namespace

double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void time_all(std::vector<Contender>& contenders, int repetitions) {
  for (Contender& c : contenders) c.median_ns = c.least_ns = std::numeric_limits<double>::infinity();
  std::mt19937 engine(1);
  std::vector<std::size_t> order(contenders.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<std::vector<double>> times(contenders.size());
  for (int round = 0; round < kRounds; ++round) {
    for (auto& t : times) t.clear();
    for (int r = 0; r < repetitions; ++r) {
      std::shuffle(order.begin(), order.end(), engine);
      for (const std::size_t i : order) {
        contenders[i].prepare();
        contenders[i].run();  // whoever came before left its own data in the caches
        contenders[i].prepare();
        const double begin = thread_seconds();
        contenders[i].run();
        times[i].push_back((thread_seconds() - begin) * 1e9 / contenders[i].items);
      }
    }
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      auto& t = times[i];
      std::sort(t.begin(), t.end());
      contenders[i].median_ns = std::min(contenders[i].median_ns, t[t.size() / 2]);
      contenders[i].least_ns = std::min(contenders[i].least_ns, t.front());
    }
  }
}

}  // namespace accrete::cli
