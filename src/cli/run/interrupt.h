// Ctrl-C and termination end a run after the frame at hand; the results are written. A second Ctrl-C ends at once.
#pragma once

namespace accrete::cli {

// Also makes a full disk and a closed pipe ordinary errors instead of deadly signals.
void install_signal_handlers();
// True once SIGINT or SIGTERM has come.
[[nodiscard]] bool interrupted();

}  // namespace accrete::cli
