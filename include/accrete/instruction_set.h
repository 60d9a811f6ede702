// Which vector instructions the filter uses: compiled for several sets, chosen once when an Accumulator is constructed.
#pragma once

namespace accrete {

enum class InstructionSet : unsigned char {
  kBest,      // the widest that this processor and this build have
  kBaseline,  // what every processor of the architecture has: SSE2 on x86-64, NEON on AArch64; 4 lanes
  kAvx2,      // with FMA: x86-64-v3; 8 lanes
  kAvx512,    // F, VL, BW and DQ: x86-64-v4; 16 lanes
};

// Whether this build has it and this processor executes it. kBest and kBaseline always are.
[[nodiscard]] bool is_available(InstructionSet set);

// "baseline", "avx2", "avx512" or "neon"; of the one that is taken for kBest. Precondition: is_available(set).
[[nodiscard]] const char* name(InstructionSet set);

}  // namespace accrete
