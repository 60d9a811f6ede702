// edges RECORDING v4l2|libcamera FORMAT FILE: what `accrete run RECORDING` does, with the images taken from the
// software cameras instead of from the files. Writes edges.csv alone.
#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "cli/run/accumulate.h"
#include "cli/run/results.h"
#include "cli/write/edges_csv.h"
#include "cli/write/snapshot.h"
#include "paced_source.h"

namespace accrete::vm {
namespace {

void check(const hal::Outcome& outcome) {
  if (!outcome.ok()) throw std::runtime_error(outcome.message);
}

std::vector<Timestamp> times_of(hal::StereoSource& recording) {
  std::vector<Timestamp> times;
  check(recording.start());
  StereoFrame frame;
  while (recording.acquire(0, frame).ok()) {
    times.push_back(frame.t_left);
    recording.release();
  }
  recording.stop();
  return times;
}

void run(const std::string& recording, const std::string& library, const std::string& format, const std::string& file) {
  cli::RunOptions options;
  options.recording = recording;
  cli::Input input = cli::open_input(options);
  options.params = cli::effective_params(options, input);

  hal::LiveOptions cameras;
  cameras.left = "Software camera 0";
  cameras.right = "Software camera 1";
  cameras.format = format;
  cameras.calibration = recording + "/stereo.yml";
  cameras.warm_up_frames = 0;
  cameras.pair_tolerance_ns = kPacedTolerance_ns;
  std::unique_ptr<hal::LiveSource> live;
  check(open_cameras(library == "v4l2" ? Library::kV4l2 : Library::kLibcamera, cameras, live));
  auto paced = std::make_unique<PacedSource>(std::move(live), times_of(*input.source));
  check(paced->configure());
  const PacedSource& source = *paced;
  input.source = std::move(paced);

  const auto engine = cli::make_engine(input.source->rig(), options.params, options.capacity);
  cli::Progress progress(stderr, 0, true);
  const cli::RunRecord record = cli::accumulate(input, *engine, options, progress);
  const auto primitives = cli::snapshot(engine->model(), record.used);
  std::ofstream to(file, std::ios::binary);
  to << cli::edges_csv(primitives, options.full_covariance, cli::encoding_of(options.params));
  if (!to.flush()) throw std::runtime_error("cannot write " + file);
  std::printf("%zu frames used, %zu primitives, %zu frames came again\n", record.used.size(), primitives.size(),
              static_cast<std::size_t>(source.repeated()));
}

}  // namespace
}  // namespace accrete::vm

int main(int argc, char** argv) {
  try {
    if (argc != 5) throw std::runtime_error("usage: edges RECORDING v4l2|libcamera FORMAT FILE");
    accrete::vm::run(argv[1], argv[2], argv[3], argv[4]);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "edges: %s\n", e.what());
    return 1;
  }
}
