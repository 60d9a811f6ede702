#include "trace.h"

#include <csignal>

#if defined(__linux__)
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

namespace accrete::bench {
namespace {

#if defined(__linux__)
long count_steps(const std::function<void()>& work) {
  const pid_t child = fork();
  if (child < 0) return -1;
  if (child == 0) {
    if (ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) _exit(1);
    raise(SIGSTOP);
    work();
    raise(SIGUSR1);
    _exit(0);
  }
  int status = 0;
  long steps = 0;
  bool finished = false;
  if (waitpid(child, &status, 0) == child && WIFSTOPPED(status)) {
    while (ptrace(PTRACE_SINGLESTEP, child, nullptr, nullptr) == 0 && waitpid(child, &status, 0) == child) {
      if (!WIFSTOPPED(status)) break;
      if (WSTOPSIG(status) == SIGUSR1) {
        finished = true;
        break;
      }
      if (WSTOPSIG(status) != SIGTRAP) break;  // it crashed
      ++steps;
    }
  }
  kill(child, SIGKILL);
  waitpid(child, &status, 0);
  return finished ? steps : -1;
}
#endif

}  // namespace

long instructions([[maybe_unused]] const std::function<void()>& work) {
#if defined(__linux__)
  static const long kOverhead = count_steps([] {});
  const long steps = count_steps(work);
  return kOverhead < 0 || steps < 0 ? -1 : steps - kOverhead;
#else
  return -1;
#endif
}

}  // namespace accrete::bench
