#include <cstdlib>

#include "cli/app.h"

int main(int argc, char** argv) {
  // libcamera tells the terminal what it does. Here errors alone; who wants more says so.
  setenv("LIBCAMERA_LOG_LEVELS", "*:ERROR", 0);
  return accrete::cli::run_app(argc, argv);
}
