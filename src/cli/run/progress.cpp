#include "cli/run/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "cli/text/print.h"

namespace accrete::cli {

Progress::Progress(std::FILE* stream, std::uint64_t total, bool quiet)
    : stream_(stream), total_(total), quiet_(quiet), terminal_(::isatty(::fileno(stream)) == 1) {}

void Progress::update(const FrameRecord& frame, const RunRecord& run) {
  if (frame.fate == FrameFate::kUsed) levels_ = frame.report;
  if (quiet_) return;
  const std::uint64_t done = run.frames.size();
  const bool last = done == total_;
  const auto now = Clock::now();
  if (terminal_) {
    constexpr auto kRedraw = std::chrono::milliseconds(80);
    if (!last && now - last_ < kRedraw) return;
  } else {
    if (!last && done < next_plain_) return;
    next_plain_ = done + (total_ > 0 ? std::max<std::uint64_t>(1, (total_ + 9) / 10) : 50);  // about ten lines in all
  }
  last_ = now;
  const double seconds = std::max(1e-6, std::chrono::duration<double>(now - begin_).count());
  const StepReport& r = levels_;
  std::string line = total_ > 0 ? fmt::format("frame {:>4} of {}", done, total_) : fmt::format("frame {:>4}", done);
  line += fmt::format("  {:6.1f} fps  {:6} confirmed  {:6} preserved  {:6} tentative",
                      static_cast<double>(done) / seconds, r.confirmed, r.preserved, r.tentative);
  if (run.lost() > 0) line += fmt::format("  {} frames lost", run.lost());
  if (terminal_)
    print_to(stream_, fmt::format("\r\x1b[K{}", line));
  else
    print_to(stream_, fmt::format("{}\n", line));
  std::fflush(stream_);
  drawn_ = terminal_;
}

void Progress::say(const std::string& line) {
  finish();
  print_to(stream_, fmt::format("{}\n", line));
}

void Progress::finish() {
  if (!drawn_) return;
  print_to(stream_, "\n");
  std::fflush(stream_);
  drawn_ = false;
}

}  // namespace accrete::cli
