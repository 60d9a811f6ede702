// What works on lanes, once per instruction set: the same source, compiled with other flags. Every object file but the
// baseline's has all its symbols but the table made local (CMakeLists.txt), so that no inline function of the standard
// library that was compiled for a better processor is ever linked into the rest.
#pragma once

#include "accrete/instruction_set.h"
#include "associate/gate_pairs.h"
#include "extract/rows.h"
#include "filter/update.h"
#include "predict/predict.h"

namespace accrete {

struct Kernels {
  const char* name;
  int lanes;
  extract::RowKernels rows;
  decltype(&accrete::predict_states) predict_states;
  decltype(&accrete::predict_observations) predict_observations;
  decltype(&accrete::add_incremental_motion_noise) add_incremental_motion_noise;
  associate::GateKernels gate;
  decltype(&accrete::update_stereo) update_stereo;
  decltype(&accrete::update_mono) update_mono;
  decltype(&accrete::update_reconstructed) update_reconstructed;
  decltype(&accrete::update_roll) update_roll;
  decltype(&accrete::update_appearance) update_appearance;
};

// Precondition: is_available(set).
[[nodiscard]] const Kernels& kernels(InstructionSet set);

}  // namespace accrete

// The tables: names without mangling, for objcopy.
#define ACCRETE_TABLE_OF(isa) accrete_kernels_##isa
#define ACCRETE_TABLE(isa) ACCRETE_TABLE_OF(isa)
extern "C" const accrete::Kernels ACCRETE_TABLE(ACCRETE_ISA);
#if defined(ACCRETE_HAS_X86_SETS)
extern "C" const accrete::Kernels accrete_kernels_avx2;
extern "C" const accrete::Kernels accrete_kernels_avx512;
#endif
