// Counts what this program takes from the heap, whichever way: malloc and its kin, and operator new on top of them.
#pragma once

#include <cstdint>

namespace accrete::test {

// Allocations since the program began, of all threads.
[[nodiscard]] std::uint64_t allocations();

}  // namespace accrete::test
