// A store with zero capacity is refused with a sentence.
// expect: kMaxPrimitives3d must be a positive multiple of 16
#include "accrete/limits.h"

struct Mine : accrete::DefaultLimits {
#ifdef BROKEN
  static constexpr std::size_t kMaxPrimitives3d = 0;
#endif
};

template struct accrete::CheckedLimits<Mine>;

int main() { return 0; }
