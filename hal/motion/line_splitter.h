// Cuts a stream of bytes into lines, in bounded memory, whatever the bytes are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "text/parse.h"

namespace accrete::hal {

class LineSplitter {
 public:
  // Calls use(line) for every line that is whole now, without its end. A line longer than Row::kMaxLength is handed
  // over once, cut and one byte too long, so that whoever parses it refuses it; its rest is skipped.
  template <class F>
  void feed(std::span<const char> bytes, F&& use) {
    for (const char c : bytes) {
      if (c == '\n') {
        if (!skipping_) use(std::string_view(line_));
        line_.clear();
        skipping_ = false;
      } else if (!skipping_) {
        line_ += c;
        if (line_.size() > Row::kMaxLength) {
          use(std::string_view(line_));
          skipping_ = true;
        }
      }
    }
  }
  // The stream has ended: what is left is a line without an end, where there is one.
  template <class F>
  void end(F&& use) {
    if (!skipping_ && !line_.empty()) use(std::string_view(line_));
    line_.clear();
    skipping_ = false;
  }

 private:
  std::string line_;
  bool skipping_ = false;
};

}  // namespace accrete::hal
