// How many operations a kernel asks of one lane: the kernel itself, run on a scalar that counts.
#pragma once

namespace accrete::bench {

struct Operations {
  long add = 0, multiply = 0, divide = 0, root = 0;
  long fused = 0;   // products that go straight into a sum: one instruction instead of two where there is FMA
  long select = 0;  // comparisons are not counted

  [[nodiscard]] long flops() const { return add + multiply; }
  // Instructions on the multiply-add ports.
  [[nodiscard]] long issued(bool has_fma) const { return add + multiply - (has_fma ? fused : 0); }
};

[[nodiscard]] Operations operations_of_predict_state();
[[nodiscard]] Operations operations_of_predict_observation();
[[nodiscard]] Operations operations_of_gate();  // both eyes
[[nodiscard]] Operations operations_of_gate_one_eye();
[[nodiscard]] Operations operations_of_update_stereo();
[[nodiscard]] Operations operations_of_update_mono();
[[nodiscard]] Operations operations_of_update_reconstructed();
[[nodiscard]] Operations operations_of_update_appearance();

}  // namespace accrete::bench
