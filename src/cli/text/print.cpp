#include "cli/text/print.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

namespace accrete::cli {
namespace {

int g_output_error = 0;  // the first of standard output

void note_failure(std::FILE* stream) {
  if (stream == stdout && g_output_error == 0) g_output_error = errno != 0 ? errno : EIO;
}

}  // namespace

void occupy_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0) ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);  // the lowest
}

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
