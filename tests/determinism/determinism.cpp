// determinism [--short] [--set baseline|avx2|avx512] [--flush] [--progress]: the golden replay on this machine. Prints
// the hash of all states and that of the measurements, then what was done. --flush: with subnormals flushed to zero by
// the processor. tests/determinism/determinism.py runs it everywhere and compares.
#include <cstdio>
#include <cstring>
#include <vector>

#include "determinism/flush.h"
#include "determinism/replay.h"
#include "determinism/size.h"

namespace {

using namespace accrete;
using namespace accrete::determinism;

struct Options {
  InstructionSet set = InstructionSet::kBest;
  bool is_short = false, flush = false, progress = false;
};

bool parse(int argc, char** argv, Options& o) {
  for (int i = 1; i < argc; ++i) {
    const auto is = [&](const char* name) { return std::strcmp(argv[i], name) == 0; };
    const char* value = i + 1 < argc ? argv[i + 1] : "";
    if (is("--flush")) {
      o.flush = true;
    } else if (is("--progress")) {
      o.progress = true;
    } else if (is("--short")) {
      o.is_short = true;
    } else if (is("--set") && std::strcmp(value, "baseline") == 0) {
      o.set = InstructionSet::kBaseline, ++i;
    } else if (is("--set") && std::strcmp(value, "avx2") == 0) {
      o.set = InstructionSet::kAvx2, ++i;
    } else if (is("--set") && std::strcmp(value, "avx512") == 0) {
      o.set = InstructionSet::kAvx512, ++i;
    } else {
      std::fprintf(stderr, "determinism: '%s' is no option, or its value is none\n", argv[i]);
      return false;
    }
  }
  return true;
}

template <class Form>
Outcome replayed(const Options& o) {
  struct alignas(64) Line {
    std::byte bytes[64];
  };
  constexpr Capacities kRoom = Accumulator<Form>::kCapacities;
  std::vector<Line> memory(storage_bytes(kRoom) / sizeof(Line));
  Pipeline* pipeline = construct_pipeline({memory.front().bytes, memory.size() * sizeof(Line)}, kRoom, o.set);
  std::vector<Edge> edges(Form::kEdges);
  std::vector<Primitive2d> left(kRoom.primitives2d), right(kRoom.primitives2d);
  Replay replay{edges, left, right, Form::kSteps, nullptr, nullptr};
  if (o.progress)
    replay.progress = [](int step, std::uint64_t state) {
      std::printf("step %d %016llx\n", step, static_cast<unsigned long long>(state));
    };
  return run(*pipeline, replay);
}

void show(const char* name, unsigned value) { std::printf(" %s=%u", name, value); }

}  // namespace

int main(int argc, char** argv) {
  Options o;
  if (!parse(argc, argv, o)) return 2;
  if (!is_available(o.set)) {
    std::printf("unavailable: this build or this processor does not have that instruction set\n");
    return 77;
  }
  if (o.flush && !flush_subnormals()) {
    std::printf("unavailable: this processor cannot be told to flush subnormals\n");
    return 77;
  }
  const Outcome out = o.is_short ? replayed<ShortForm>(o) : replayed<LongForm>(o);
  std::printf("%016llx %016llx", static_cast<unsigned long long>(out.state),
              static_cast<unsigned long long>(out.measurements));
  const Totals& t = out.totals;
  std::printf(" set=%s", name(o.set));
  show("primitives", out.primitives);
  show("observed", t.observed);
  show("born", t.born);
  show("updated", t.updated);
  show("stereo", t.stereo);
  show("mono", t.mono);
  show("missed", t.missed);
  show("ambiguous", t.ambiguous);
  show("starved", t.starved);
  show("confirmed", t.confirmed);
  show("preserved", t.preserved);
  show("deleted_existence", t.deleted_existence);
  show("deleted_undecided", t.deleted_undecided);
  show("deleted_background", t.deleted_background);
  show("merged", t.merged);
  show("evicted", t.evicted);
  std::printf("\n");
  return 0;
}
