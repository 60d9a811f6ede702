// What the program says on its standard streams. Saying is best effort: a full disk, or a terminal or pipe that is
// gone, ends no run and loses no results, so nothing here throws for that, as fmt::print would.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string_view>
#include <utility>

namespace accrete::cli {

// At the beginning: whoever was started without one of the standard streams must not open a file in its place, which
// would get what is said. Writing there fails from now on.
void occupy_standard_streams();

void print_to(std::FILE* stream, std::string_view text);

template <class... Args>
void print(fmt::format_string<Args...> format, Args&&... args) {
  print_to(stdout, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void print_error(fmt::format_string<Args...> format, Args&&... args) {
  print_to(stderr, fmt::format(format, std::forward<Args>(args)...));
}

// So that what was said on standard output stands before what is said on standard error from now on.
void flush_output();
// Flushes, too. 0 when all that was printed on standard output has arrived, else the first errno.
[[nodiscard]] int standard_output_error();

}  // namespace accrete::cli
