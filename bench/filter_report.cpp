#include "filter_report.h"

#include <fmt/format.h>

namespace accrete::bench {
namespace {

constexpr std::size_t kMiddle = 1;  // index of the pool of 1024: it fits a second-level cache

std::string set_name(const SetCost& s) { return fmt::format("{} x{}", s.set, s.lanes); }

std::string rule(std::size_t columns) {
  std::string out = "|---|";
  for (std::size_t i = 0; i < columns; ++i) out += "---:|";
  return out + "\n";
}

std::string header(const std::string& first, const std::vector<SetCost>& sets) {
  std::string out = "| " + first + " |";
  for (const SetCost& s : sets) out += " " + set_name(s) + " |";
  return out + "\n" + rule(sets.size());
}

std::string cell(double value) {
  if (value < 0) return " - |";
  return value < 100 ? fmt::format(" {:.1f} |", value) : fmt::format(" {:.0f} |", value);
}

std::string rows_table(const FilterReport& r, std::size_t size) {
  std::string out = header("ns per primitive", r.costs[size]);
  for (std::size_t row = 0; row < r.rows.size(); ++row) {
    out += "| " + r.rows[row] + " |";
    for (const SetCost& s : r.costs[size]) out += cell(s.ns[row]);
    out += "\n";
  }
  return out;
}

std::string instruction_table(const FilterReport& r) {
  std::string out = header("instructions per primitive", r.costs[0]);
  for (std::size_t row = 0; row < r.rows.size(); ++row) {
    out += "| " + r.rows[row] + " |";
    for (const SetCost& s : r.costs[0]) out += cell(s.instructions[row]);
    out += "\n";
  }
  out += "| calls of malloc, all rows |";
  for (const SetCost& s : r.costs[0]) out += fmt::format(" {:g} |", s.allocations);
  return out + "\n";
}

std::string limits_table(const FilterReport& r) {
  std::string out = header("one vector instruction, ns", r.costs[kMiddle]);
  const auto line = [&](const char* name, auto value, const char* format) {
    out += fmt::format("| {} |", name);
    for (const Peak& p : r.peaks) out += fmt::format(fmt::runtime(format), value(p));
    out += "\n";
  };
  line(
      "multiply-add", [](const Peak& p) { return p.multiply_add_ns; }, " {:.3f} |");
  line(
      "division", [](const Peak& p) { return p.divide_ns; }, " {:.3f} |");
  line(
      "square root", [](const Peak& p) { return p.root_ns; }, " {:.3f} |");
  line(
      "GFLOP/s of multiply-adds", [](const Peak& p) { return p.gflops(); }, " {:.1f} |");
  return out;
}

// Least time on the arithmetic ports alone.
double bound_ns(const Operations& o, const Peak& p) {
  const double one = p.fused ? p.multiply_add_ns : p.multiply_add_ns / 2;
  return (static_cast<double>(o.issued(p.fused)) * one + static_cast<double>(o.divide) * p.divide_ns +
          static_cast<double>(o.root) * p.root_ns) /
         p.lanes;
}

std::string bound_tables(const FilterReport& r) {
  std::string out =
      "| operations per primitive | add | multiply | of them fused | divide | root | select | flops |\n" + rule(7);
  for (const KernelOperations& k : r.operations) {
    const Operations& o = k.operations;
    out += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} |\n", r.rows[k.row], o.add, o.multiply, o.fused,
                       o.divide, o.root, o.select, o.flops());
  }
  out += "\n" + header("bound, ns / share of it reached / share of the multiply-add peak", r.costs[kMiddle]);
  for (const KernelOperations& k : r.operations) {
    out += "| " + r.rows[k.row] + " |";
    for (std::size_t s = 0; s < r.peaks.size(); ++s) {
      const double bound = bound_ns(k.operations, r.peaks[s]), ns = r.costs[kMiddle][s].ns[k.row];
      out += fmt::format(" {:.1f} / {:.0f} % / {:.0f} % |", bound, 100 * bound / ns,
                         100 * static_cast<double>(k.operations.flops()) / ns / r.peaks[s].gflops());
    }
    out += "\n";
  }
  return out;
}

std::string peer_table(const FilterReport& r) {
  const SetCost& best = r.costs[kMiddle].back();
  const double ours = best.ns.back();
  std::string out =
      "| filter | ns per update | times ours | instructions | malloc calls | bytes | differs from ours: offset, sigma "
      "| tangent, mrad |\n" +
      rule(7);
  for (const std::size_t s : {r.costs[kMiddle].size() - 1, std::size_t{2}, std::size_t{1}}) {
    const SetCost& c = r.costs[kMiddle][s];
    out += fmt::format("| ours, {} | {:.1f} | {:.1f} | {:.0f} | {:g} | {} | - | - |\n", set_name(c), c.ns.back(),
                       c.ns.back() / ours, r.costs[0][s].instructions.back(), c.allocations, 4 * (28 + 35));
  }
  for (const PeerCost& p : r.peers)
    out += fmt::format("| {} | {:.0f} | {:.0f} | {:.0f} | {:g} | {:.0f} | {:.3f} | {:.2f} |\n", p.name, p.ns,
                       p.ns / ours, p.instructions, p.allocations, p.bytes, p.offset_sigma, p.angle_mrad);
  return out;
}

std::string decomposition(const FilterReport& r) {
  const auto& sets = r.costs[kMiddle];
  const double fixed = r.peers[0].ns, block = r.peers[1].ns, one_double = sets[0].ns.back(),
               one_float = sets[1].ns.back(), native = sets[2].ns.back(), best = sets.back().ns.back();
  return fmt::format(
      "{:.0f} = {:.1f} (block structure: 6 states by sigma points, 7 by a Kalman filter) x {:.1f} (algebra: the motion "
      "in closed form, moments instead of projections, triangular roots, no libm) x {:.2f} (float) x {:.1f} (fused "
      "multiply-adds) x {:.1f} ({} lanes).\n",
      fixed / best, fixed / block, block / one_double, one_double / one_float, one_float / native, native / best,
      sets.back().lanes);
}

}  // namespace

std::string FilterReport::markdown() const {
  std::string out = fmt::format(
      "# bench/filter\n\ncommit {}  \ncompiler {}  \nflags {}  \nprocessor {}\n\n"
      "Processor time of one thread, the least of five medians, everything in one run and in turns. Columns: "
      "`one_double`, `one_lane` and `one_native` are the same source for a single primitive, the last compiled for "
      "this "
      "processor; the others are the instruction sets of the library. The rows are explained in "
      "docs/benchmarks.md.\n\n",
      commit, compiler, flags, processor);
  out += "## Cost\n";
  for (std::size_t s = 0; s < sizes.size(); ++s)
    out += fmt::format("\n{} primitives:\n\n{}", sizes[s], rows_table(*this, s));
  out += "\nCounted one by one:\n\n" + instruction_table(*this);
  out +=
      "\n## Other filters\n\nThe last row of the table above, 1024 primitives, against one object for each of 64.\n\n" +
      peer_table(*this) + "\nAgainst the first of them: " + decomposition(*this);
  out += "\n## Limits\n\n" + limits_table(*this) + "\n" + bound_tables(*this);
  return out;
}

}  // namespace accrete::bench
