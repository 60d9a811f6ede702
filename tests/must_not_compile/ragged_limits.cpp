// The store is made of blocks of 16; an Accumulator with another capacity is refused with a sentence.
// expect: kMaxPrimitives3d must be a positive multiple of 16
#include "accrete/accumulator.h"

struct Mine : accrete::SmallLimits {
#ifdef BROKEN
  static constexpr std::size_t kMaxPrimitives3d = 1000;
#endif
};

void use(accrete::Accumulator<Mine>& accumulator) { accumulator.reset(); }
