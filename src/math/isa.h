// The instruction set that a file is compiled for. It is part of every name of what works on lanes, so that the linker
// cannot mix two builds of one template.
#pragma once

#if defined(ACCRETE_ISA)
// The build says what it wants, ACCRETE_LANE_WIDTH as well: one lane, or double instead of float, for comparison.
#elif defined(__AVX512F__)
#define ACCRETE_ISA avx512
#define ACCRETE_LANE_WIDTH 16
#elif defined(__AVX2__)
#define ACCRETE_ISA avx2
#define ACCRETE_LANE_WIDTH 8
#elif defined(__aarch64__)
#define ACCRETE_ISA neon
#define ACCRETE_LANE_WIDTH 4
#else
#define ACCRETE_ISA baseline
#define ACCRETE_LANE_WIDTH 4
#endif
#if !defined(ACCRETE_LANE_SCALAR)
#define ACCRETE_LANE_SCALAR float  // what one lane alone is; packs are always float
#endif

// Before a loop that shall stay one.
#if defined(__clang__)
#define ACCRETE_ROLLED _Pragma("clang loop unroll(disable)")
#else
#define ACCRETE_ROLLED _Pragma("GCC unroll 1")
#endif
