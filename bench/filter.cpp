// Cost of the filter's kernels, of the machine's arithmetic, and of other filters, in one run.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "allocations.h"
#include "cli/bench/processor.h"
#include "cli/bench/rows.h"
#include "cli/bench/timing.h"
#include "filter_report.h"
#include "peers/peer.h"
#include "trace.h"

extern "C" const accrete::Kernels accrete_kernels_one_lane;
extern "C" const accrete::Kernels accrete_kernels_one_double;
extern "C" const accrete::Kernels accrete_kernels_one_native;

namespace accrete::bench {
namespace {

using cli::BenchPool;
using cli::Contender;

struct Set {
  const Kernels* kernels;
  Arithmetic arithmetic;
};

std::vector<Set> sets_of_this_machine() {
#if defined(__x86_64__)
  const bool fused = __builtin_cpu_supports("fma") != 0;
#else
  const bool fused = true;
#endif
  std::vector<Set> out{{&accrete_kernels_one_double, {1, true, false}},
                       {&accrete_kernels_one_lane, {1, false, false}},
                       {&accrete_kernels_one_native, {1, false, fused}}};
  for (const InstructionSet set : {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (!is_available(set)) continue;
    const Kernels& k = kernels(set);
    if (can_run(k.lanes)) out.push_back({&k, {k.lanes, false, k.lanes >= 8}});
  }
  return out;
}

double per(long count, std::size_t items) {
  return count < 0 ? -1 : static_cast<double>(count) / static_cast<double>(items);
}

// rms of the offset across the line, in sigmas of ours, and of the angle between the tangents.
void compare(const Peer& peer, const BenchPool& pool, PeerCost& cost) {
  double offset = 0, angle = 0;
  for (std::size_t i = 0; i < pool.size; ++i) {
    const Geometry g = load(pool.geometry[i / kBlockLanes], i % kBlockLanes);
    const Mat3 R =
        to_matrix({double{g.quaternion[0]}, double{g.quaternion[1]}, double{g.quaternion[2]}, double{g.quaternion[3]}});
    const PeerEstimate e = peer.estimate(i);
    const Vec3 d{e.position[0] - double{g.position[0]}, e.position[1] - double{g.position[1]},
                 e.position[2] - double{g.position[2]}};
    const Vec3 theirs{e.tangent[0], e.tangent[1], e.tangent[2]};
    for (std::size_t axis = 1; axis < 3; ++axis) {  // local y and z
      const Vec3 n{R[axis], R[3 + axis], R[6 + axis]};
      const auto variance = double{g.covariance[packed_index(6, axis, axis)]};
      offset += 0.5 * dot(d, n) * dot(d, n) / variance;
      angle += dot(theirs, n) * dot(theirs, n);
    }
  }
  cost.offset_sigma = std::sqrt(offset / static_cast<double>(pool.size));
  cost.angle_mrad = 1e3 * std::sqrt(angle / static_cast<double>(pool.size));
}

std::vector<std::unique_ptr<Peer>> make_peers(const BenchPool& pool) {
  std::vector<std::unique_ptr<Peer>> out;
  out.push_back(fixed_eigen_double(pool));
  out.push_back(block_eigen(pool));
  out.push_back(fixed_eigen_float(pool));
  out.push_back(dynamic_eigen(pool));
  if (auto peer = opencv(pool)) out.push_back(std::move(peer));
  return out;
}

// Everything that is not timed: instructions, allocations, and whether the peers come to the same estimates.
void count(FilterReport& report, const std::vector<Set>& sets) {
  const auto rows = cli::bench_rows();
  constexpr std::size_t kFew = 64;
  BenchPool pool(kFew), less(kBlockLanes), one(1);
  for (std::size_t s = 0; s < sets.size(); ++s) {
    SetCost& cost = report.costs[0][s];
    for (const cli::BenchRow& row : rows) {
      pool.restore();
      BenchPool& traced = sets[s].kernels->lanes == 1 ? less : pool;
      traced.restore();
      cost.instructions.push_back(per(instructions([&] { row.run(*sets[s].kernels, traced, 1); }), traced.size));
      const long before = allocations();
      row.run(*sets[s].kernels, pool, 8);
      cost.allocations += per(allocations() - before, 8 * kFew);
    }
    for (std::size_t size = 1; size < report.sizes.size(); ++size) report.costs[size][s].allocations = cost.allocations;
  }
  pool.restore();
  const BenchPool born(kFew);
  rows.back().run(*sets.back().kernels, pool, BenchPool::kFrames);
  const auto peers = make_peers(born), small = make_peers(one);
  for (std::size_t i = 0; i < peers.size(); ++i) {
    PeerCost cost{peers[i]->name(), 0, 0, 0, static_cast<double>(peers[i]->bytes()), 0, 0};
    const long before = allocations();
    for (std::size_t f = 0; f < BenchPool::kFrames; ++f) peers[i]->frame(f);
    cost.allocations = per(allocations() - before, BenchPool::kFrames * kFew);
    compare(*peers[i], pool, cost);
    cost.instructions = per(instructions([&] { small[i]->frame(0); }), 1);
    report.peers.push_back(cost);
  }
}

void time(FilterReport& report, const std::vector<Set>& sets, int repetitions) {
  std::vector<std::unique_ptr<BenchPool>> pools;
  std::vector<Contender> contenders;
  for (const std::size_t n : report.sizes) {
    BenchPool& pool = *pools.emplace_back(std::make_unique<BenchPool>(n));
    const std::size_t frames = cli::bench_frames(n);
    for (const Set& set : sets)
      for (const cli::BenchRow& row : cli::bench_rows())
        contenders.push_back({row.key, [&pool] { pool.restore(); },
                              [&row, &pool, &set, frames] { row.run(*set.kernels, pool, frames); },
                              static_cast<double>(n * frames)});
  }
  for (const Set& set : sets) add_peak(set.arithmetic, contenders);
  const BenchPool few(64);
  const auto peers = make_peers(few);
  for (const auto& peer : peers)
    contenders.push_back({peer->name(), [&peer] { peer->restore(); },
                          [&peer] {
                            for (std::size_t f = 0; f < BenchPool::kFrames; ++f) peer->frame(f);
                          },
                          static_cast<double>(few.size * BenchPool::kFrames)});
  cli::time_all(contenders, repetitions);

  const Contender* at = contenders.data();
  for (auto& costs : report.costs)
    for (SetCost& cost : costs)
      for (std::size_t row = 0; row < report.rows.size(); ++row) cost.ns.push_back(at++->median_ns);
  for (const Set& set : sets) {
    report.peaks.push_back(peak_from(set.arithmetic, at));
    at += 3;
  }
  for (PeerCost& peer : report.peers) peer.ns = at++->median_ns;
}

std::size_t row_of(std::string_view key) {
  const auto rows = cli::bench_rows();
  std::size_t i = 0;
  while (i < rows.size() && rows[i].key != key) ++i;
  return i;
}

// The Eigen peers solve the same problem: what differs is where the sigma points lie (sqrt 13 instead of sqrt 6).
bool peers_agree(const FilterReport& report) {
  bool all = true;
  for (std::size_t i = 0; i < 4; ++i) {
    const PeerCost& p = report.peers[i];
    if (p.offset_sigma < 0.1 && p.angle_mrad < 10) continue;
    fmt::print(stderr, "filter: '{}' differs from ours by {:.3f} sigma and {:.2f} mrad: not the same filter\n", p.name,
               p.offset_sigma, p.angle_mrad);
    all = false;
  }
  return all;
}

// A folder's name out of a processor's.
std::string slug(const std::string& name) {
  std::string out;
  for (const char c : name) {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalnum(u) != 0)
      out += static_cast<char>(std::tolower(u));
    else if (!out.empty() && out.back() != '-')
      out += '-';
  }
  while (!out.empty() && out.back() == '-') out.pop_back();
  return out;
}

int run(int argc, char** argv) {
  CLI::App app{"What the filter costs, against other filters and against what the machine can do."};
  std::string out, commit = "unknown";
  int repetitions = 5;
  const std::vector<std::size_t> sizes{64, 1024, 16384};
  app.add_option("--results", out, "Write the page to filter.md in this folder's folder of the processor, too");
  app.add_option("--commit", commit, "What is measured, for the page's first line");
  app.add_option("--repetitions", repetitions, "Repetitions of each of five rounds (default 5)")
      ->check(CLI::Range(1, 1000));
  CLI11_PARSE(app, argc, argv);

  const std::vector<Set> sets = sets_of_this_machine();
  FilterReport report;
  report.commit = commit;
  report.compiler = __VERSION__;
  report.flags = ACCRETE_BENCH_FLAGS;
  report.processor = cli::processor_name();
  report.sizes = sizes;
  for (const cli::BenchRow& row : cli::bench_rows()) report.rows.emplace_back(row.name);
  std::vector<SetCost> empty;
  for (const Set& s : sets) empty.push_back({s.kernels->name, s.kernels->lanes, {}, {}, 0});
  report.costs.assign(sizes.size(), empty);
  report.operations = {{row_of("predict_state"), operations_of_predict_state()},
                       {row_of("predict_observation"), operations_of_predict_observation()},
                       {row_of("gate"), operations_of_gate()},
                       {row_of("gate_one_eye"), operations_of_gate_one_eye()},
                       {row_of("update_stereo"), operations_of_update_stereo()},
                       {row_of("update_mono"), operations_of_update_mono()},
                       {row_of("update_reconstructed"), operations_of_update_reconstructed()},
                       {row_of("update_appearance"), operations_of_update_appearance()}};
  count(report, sets);
  const bool agree = peers_agree(report);
  time(report, sets, repetitions);
  const std::string page = report.markdown();
  fmt::print("{}", page);
  if (!out.empty()) {
    const std::filesystem::path folder = std::filesystem::path(out) / slug(report.processor);
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    std::ofstream file(folder / "filter.md");
    if (!(file << page).flush()) {
      fmt::print(stderr, "filter: {} cannot be written\n", (folder / "filter.md").string());
      return 1;
    }
  }
  return agree ? 0 : 1;
}

}  // namespace
}  // namespace accrete::bench

int main(int argc, char** argv) { return accrete::bench::run(argc, argv); }
