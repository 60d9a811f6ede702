// The core alone: an accumulator in static storage, of a program without exceptions in mind.
#include <accrete/accumulator.h>
#include <accrete/version.h>

#include <cstdio>

static accrete::Accumulator<accrete::SmallLimits> accumulator;

int main() {
  const accrete::Status status = accumulator.configure(accrete::StereoRig{});  // no cameras in it
  std::printf("accrete %s: %s, %zu primitives\n", accrete::kVersion, accrete::to_string(status),
              accumulator.model().size());
  return status == accrete::Status::kInvalidArgument ? 0 : 1;
}
