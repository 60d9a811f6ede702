// Ctrl-C, termination and a terminal that is closed end a run after the frame at hand; the results are written. A
// second Ctrl-C ends at once.
#pragma once

namespace accrete::cli {

// Makes a full disk and a closed pipe ordinary errors instead of deadly signals.
void ignore_output_signals();
// From now on; only for what asks interrupted() all the time: the first Ctrl-C no longer ends the program.
void catch_interrupts();
// True once SIGINT, SIGTERM or SIGHUP has come.
[[nodiscard]] bool interrupted();

}  // namespace accrete::cli
