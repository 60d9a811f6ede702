// Limits that contradict each other are refused with a sentence.
// expect: kMaxStereoMatches must be at least kMaxPrimitives2d
#include "accrete/limits.h"

struct Mine : accrete::DefaultLimits {
#ifdef BROKEN
  static constexpr std::size_t kMaxStereoMatches = 100;
#endif
};

template struct accrete::CheckedLimits<Mine>;

int main() { return 0; }
