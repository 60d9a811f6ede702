// One whole Accumulator with every member, for the check of its symbols.
#include "accrete/accumulator.h"

template class accrete::Accumulator<accrete::DefaultLimits>;
