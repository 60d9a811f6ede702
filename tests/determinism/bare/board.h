// What the golden replay needs of a microcontroller.
#pragma once

#include <cstddef>

namespace accrete::bare {

void print(const char* text);
// Bytes of stack used since reset: what is left of the paint tells.
[[nodiscard]] std::size_t deepest_stack();
int main();  // the program; what it returns ends the emulation

}  // namespace accrete::bare
