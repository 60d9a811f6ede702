// order WORD...: one order to the software cameras, for scripts.
#include <cstdio>
#include <exception>
#include <string>

#include "orders.h"

int main(int argc, char** argv) {
  std::string line;
  for (int i = 1; i < argc; ++i) line += std::string(i > 1 ? " " : "") + argv[i];
  try {
    accrete::vm::order(line);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "order: %s\n", e.what());
    return 1;
  }
}
