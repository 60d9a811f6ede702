#include "cli/text/print.h"

#include <cerrno>

namespace accrete::cli {
namespace {

int g_output_error = 0;  // the first of standard output

void note_failure(std::FILE* stream) {
  if (stream == stdout && g_output_error == 0) g_output_error = errno != 0 ? errno : EIO;
}

}  // namespace

void print_to(std::FILE* stream, std::string_view text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stream) != text.size()) note_failure(stream);
}

void flush_output() {
  errno = 0;
  if (std::fflush(stdout) != 0) note_failure(stdout);
}

int standard_output_error() {
  flush_output();
  return g_output_error;
}

}  // namespace accrete::cli
