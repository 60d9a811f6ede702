// The short form of the golden replay on a microcontroller without an operating system: the same hashes as everywhere.
#include "accrete/contract.h"
#include "determinism/bare/board.h"
#include "determinism/replay.h"
#include "determinism/size.h"

namespace accrete::bare {
namespace {

constexpr Capacities kRoom = Accumulator<determinism::ShortForm>::kCapacities;

// Static, as on a real board; named, so that `size` and `nm` tell what each takes.
alignas(64) std::byte accumulator_memory[storage_bytes(kRoom)];
determinism::Edge edges[determinism::ShortForm::kEdges];
Primitive2d observed_left[kRoom.primitives2d], observed_right[kRoom.primitives2d];

void print_hex(std::uint64_t value) {
  char text[17] = {};
  for (int i = 0; i < 16; ++i) text[i] = "0123456789abcdef"[(value >> (60 - 4 * i)) & 15];
  print(text);
}

void print_count(const char* name, std::size_t value) {
  char text[12] = {};
  int i = 11;
  do {
    text[--i] = static_cast<char>('0' + value % 10);
    value /= 10;
  } while (value > 0);
  print(name);
  print(text + i);
}

}  // namespace

int main() {
  set_contract_handler([](const ContractViolation& v) {
    print("contract: ");
    print(v.condition);
    print("\n");
  });
  Pipeline* pipeline = construct_pipeline(accumulator_memory, kRoom);
  const std::size_t before = deepest_stack();
  const determinism::Outcome out = determinism::run(
      *pipeline, {edges, observed_left, observed_right, determinism::ShortForm::kSteps, nullptr, nullptr});
  print_hex(out.state);
  print(" ");
  print_hex(out.measurements);
  print(" set=one_lane");
  print_count(" primitives=", out.primitives);
  print_count(" stack=", deepest_stack());
  print_count(" stack_before=", before);
  print("\n");
  return 0;
}

}  // namespace accrete::bare
