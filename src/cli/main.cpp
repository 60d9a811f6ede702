#include "cli/app.h"

int main(int argc, char** argv) { return accrete::cli::run_app(argc, argv); }
