// Between the start-up code of tests/determinism/bare and the example: what it returns ends the emulation.
#include "determinism/bare/board.h"

int example_main();

int accrete::bare::main() { return example_main(); }
