// Calls of malloc and its family in this program, everything that it is linked with included.
#pragma once

namespace accrete::bench {

[[nodiscard]] long allocations();

}  // namespace accrete::bench
