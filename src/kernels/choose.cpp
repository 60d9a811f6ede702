#include "accrete/contract.h"
#include "kernels/kernels.h"

namespace accrete {
namespace {

#if defined(ACCRETE_HAS_X86_SETS)
bool has_avx2() {
  __builtin_cpu_init();  // a static constructor of somebody else may be first
  return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
}
bool has_avx512() {
  return has_avx2() && __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512vl") != 0 &&
         __builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512dq") != 0;
}
#endif

}  // namespace

bool is_available([[maybe_unused]] InstructionSet set) {
#if defined(ACCRETE_HAS_X86_SETS)
  if (set == InstructionSet::kAvx2) return has_avx2();
  if (set == InstructionSet::kAvx512) return has_avx512();
#endif
  return set == InstructionSet::kBest || set == InstructionSet::kBaseline;
}

const char* name(InstructionSet set) { return kernels(set).name; }

const Kernels& kernels([[maybe_unused]] InstructionSet set) {
  ACCRETE_EXPECTS(is_available(set));
#if defined(ACCRETE_HAS_X86_SETS)
  const bool best = set == InstructionSet::kBest;
  if (set == InstructionSet::kAvx512 || (best && has_avx512())) return accrete_kernels_avx512;
  if (set == InstructionSet::kAvx2 || (best && has_avx2())) return accrete_kernels_avx2;
#endif
  return ACCRETE_TABLE(ACCRETE_ISA);
}

}  // namespace accrete
