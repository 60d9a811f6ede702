// How many instructions a piece of work executes: counted exactly, one by one, in a child process that is traced. Works
// where there is no counter (virtual machines) and for every instruction set, at about a microsecond an instruction.
#pragma once

#include <functional>

namespace accrete::bench {

// -1 where processes may not be traced.
[[nodiscard]] long instructions(const std::function<void()>& work);

}  // namespace accrete::bench
