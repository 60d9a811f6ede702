// A second processor for a step. The core starts no thread: whoever has one lends it.
#pragma once

namespace accrete {

// What a step does once for the left image and once for the right one, which is three quarters of its time
// (docs/howto/real_time.md). Results are the same bits with and without a runner, whoever runs what.
struct PairRunner {
  // Calls task(argument, 0) and task(argument, 1) once each, at the same time or one after the other, in any threads,
  // and returns when both have returned; what they wrote is then visible to the caller. Throws nothing. nullptr: a
  // step calls both itself.
  void (*run)(void* context, void (*task)(void* argument, int which), void* argument) = nullptr;
  void* context = nullptr;
};

}  // namespace accrete
