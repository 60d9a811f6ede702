// Reset of a Cortex-M under an emulator: memory, the floating-point unit, output and the end by semihosting (Arm's
// "Semihosting for AArch32 and AArch64").
#include <cstddef>
#include <cstdint>

#include "determinism/bare/board.h"

extern "C" {
extern std::uint32_t image_data[], data_begin[], data_end[], bss_begin[], bss_end[], stack_begin[], stack_end[];
using Constructor = void (*)();
extern Constructor init_array_begin[], init_array_end[];

[[noreturn]] void reset();
[[noreturn]] void fault();

// Nothing is destroyed: the program never ends.
void* __dso_handle;
int __aeabi_atexit(void*, void (*)(void*), void*) { return 0; }
}

namespace accrete::bare {
namespace {

constexpr std::uint32_t kPaint = 0xa5a5a5a5;

std::uint32_t semihosting(std::uint32_t operation, const void* argument) {
  register std::uint32_t r0 __asm__("r0") = operation;
  register const void* r1 __asm__("r1") = argument;
  __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}

[[noreturn]] void finish(int status) {
  constexpr std::uint32_t kExitExtended = 0x20, kApplicationExit = 0x20026;
  const std::uint32_t block[2] = {kApplicationExit, static_cast<std::uint32_t>(status)};
  for (;;) semihosting(kExitExtended, block);
}

}  // namespace

void print(const char* text) {
  constexpr std::uint32_t kWrite0 = 0x04;
  semihosting(kWrite0, text);
}

std::size_t deepest_stack() {
  const volatile std::uint32_t* p = stack_begin;
  while (p < stack_end && *p == kPaint) ++p;
  return static_cast<std::size_t>(stack_end - p) * sizeof(std::uint32_t);
}

}  // namespace accrete::bare

void fault() {
  accrete::bare::print("fault\n");
  accrete::bare::finish(3);
}

void reset() {
  // CPACR: full access to the coprocessors 10 and 11, which are the floating-point unit.
  *reinterpret_cast<volatile std::uint32_t*>(0xe000ed88) |= 0xfU << 20;
  __asm__ volatile("dsb\nisb");
  std::uint32_t* here = nullptr;
  __asm__ volatile("mov %0, sp" : "=r"(here));
  for (volatile std::uint32_t* p = stack_begin; p < here - 64; ++p) *p = accrete::bare::kPaint;  // not below our feet
  for (volatile std::uint32_t *from = image_data, *to = data_begin; to < data_end; ++from, ++to) *to = *from;
  for (volatile std::uint32_t* p = bss_begin; p < bss_end; ++p) *p = 0;
  for (Constructor* c = init_array_begin; c < init_array_end; ++c) (*c)();
  accrete::bare::finish(accrete::bare::main());
}

[[gnu::section(".vectors"), gnu::used]] void* const vectors[16] = {stack_end,
                                                                   reinterpret_cast<void*>(reset),
                                                                   reinterpret_cast<void*>(fault),
                                                                   reinterpret_cast<void*>(fault),
                                                                   reinterpret_cast<void*>(fault),
                                                                   reinterpret_cast<void*>(fault),
                                                                   reinterpret_cast<void*>(fault)};
