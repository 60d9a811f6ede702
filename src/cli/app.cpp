#include "cli/app.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <sstream>

#include "accrete/version.h"
#include "cli/bench/bench_command.h"
#include "cli/devices/devices_command.h"
#include "cli/doctor/doctor_command.h"
#include "cli/evaluate/evaluate_command.h"
#include "cli/evaluate/selftest.h"
#include "cli/failure.h"
#include "cli/info.h"
#include "cli/record/record_command.h"
#include "cli/run/interrupt.h"
#include "cli/run/run_command.h"
#include "cli/text/print.h"

namespace accrete::cli {
namespace {

constexpr const char* kAbout =
    "accrete accumulates a 3D model of edges from stereo images of something that moves in a known way.";

constexpr const char* kExamples = R"(
Examples
  accrete run                          the synthetic scene: needs nothing
  accrete run RECORDING                a folder with images, calibration and poses
  accrete run RECORDING --overlay 5    with pictures of every 5th frame
  accrete record SOURCE -o FOLDER      keep what a source delivers, as a EuRoC folder
  accrete devices                      the cameras of this machine
  accrete run v4l2:LEFT,RIGHT --calibration stereo.yml --poses robot_object.txt
  accrete info RECORDING               what would be read, and how; computes nothing
  accrete doctor RECORDING             is the rig sane? what is wrong, and what to do
  accrete evaluate RECORDING           accuracy against RECORDING/truth
  accrete selftest                     is this build sound?
  accrete bench                        what a primitive costs on this machine

Exit status: 0 done, every frame used; 1 nothing accumulated; 2 wrong command line; 3 done, but some frames could
not be used; 4 input not readable; 5 results not written; 6 doctor: something is wrong
with the rig; 130 interrupted, results written.)";

constexpr const char* kRunExamples = R"(
Examples
  accrete run                                         the synthetic scene
  accrete run box/ --out box-model --full-covariance
  accrete run box/ --depth-range 0.4:0.9 --pose-sigma 0.3mm:1mrad
  accrete run box/ --exclude-box -0.02,-0.02,0.1,0.02,0.02,0.2
  accrete run drive/ --motion camera --poses odometry.txt --frames 12:50

A recording is a plain folder (left/ right/ stereo.yml, object_poses.txt or poses_camera.txt), EuRoC, KITTI odometry,
live cameras (v4l2:LEFT,RIGHT, until Ctrl-C) or synthetic:NAME. Kind, calibration and poses are found and printed; the
flags override what was found.)";

constexpr const char* kRecordExamples = R"(
Examples
  accrete record synthetic:box -o box               a folder that run, info and evaluate read
  accrete record drive/ --frames 100:200 -o piece
  robot | accrete record SOURCE --poses - -o box    with poses that arrive meanwhile

Whatever ends the recording, also a full disk or kill -9, everything up to the last complete frame can be replayed.)";

constexpr const char* kEvaluateExamples = R"(
Examples
  accrete evaluate box/                               against box/truth
  accrete evaluate temple/ --hold-out 5               against every 5th frame, kept aside
  accrete evaluate box/ --edges results/latest/edges.csv
  accrete evaluate synthetic:box --markdown page.md)";

constexpr const char* kDoctorExamples = R"(
Examples
  accrete doctor box/
  accrete doctor drive/ --frames 100:300 --calibration new.yml --json

Exit status: 0 nothing is wrong; 6 something is.)";

// One command: its flags, and what it does once they have been parsed.
struct Commands {
  RunFlags run, info, evaluate, record, doctor;
  RecordFlags recording;
  DoctorOptions examination;
  EvaluateOptions evaluation;
  SelftestOptions selftest;
  BenchOptions bench;
  DevicesOptions devices;
  std::vector<std::string> command_line;

  void add_to(CLI::App& app);
  [[nodiscard]] ExitStatus execute(const CLI::App& app);
};

void add_evaluate_flags(CLI::App& app, EvaluateOptions& options) {
  const char* group = "What to measure and where to write it";
  const auto option = [&app, group](const char* name, auto& value, const char* kind, const char* help) {
    return app.add_option(name, value, help)->option_text(kind)->group(group);
  };
  option("--hold-out", options.hold_out, "N", "Keep every N-th frame aside and compare the model with it")
      ->check(CLI::Range(2, 1000000));
  option("--truth", options.truth, "FOLDER", "Folder with the truth (default RECORDING/truth)");
  option("--edges", options.edges, "FILE", "Score this edges.csv instead of running");
  option("--judge-above", options.min_existence, "P", "Least existence probability that counts (default 0.9)")
      ->check(CLI::Range(0.0, 1.0));
  option("--markdown", options.markdown, "FILE", "Write the tables to a Markdown page, as a section of this recording");
  option("-o,--out", options.run.out, "FOLDER", "Write the result files of run there too");
  app.add_flag("--json", options.run.json, "Print everything as JSON on standard output")->group(group);
  app.add_flag("-q,--quiet", options.run.quiet, "No progress, no description of the recording")->group(group);
}

void Commands::add_to(CLI::App& app) {
  CLI::App& run_command = *app.add_subcommand("run", "Accumulate a model from a recording and write it");
  run.add_input(run_command);
  run.add_cameras(run_command);
  run.add_accumulation(run_command);
  run.add_output(run_command);
  run_command.footer(kRunExamples);

  CLI::App& record_command = *app.add_subcommand("record", "Keep what a source delivers, as a EuRoC folder");
  record.add_input(record_command);
  record.add_cameras(record_command);
  recording.add(record_command);
  record_command.footer(kRecordExamples);

  CLI::App& info_command = *app.add_subcommand("info", "Say what would be read, and with which conventions");
  info.add_input(info_command);
  info.add_cameras(info_command);

  CLI::App& evaluate_command = *app.add_subcommand("evaluate", "Accumulate, and score against truth or unseen images");
  evaluate.add_input(evaluate_command);
  evaluate.add_accumulation(evaluate_command);
  add_evaluate_flags(evaluate_command, evaluation);
  evaluate_command.footer(kEvaluateExamples);

  CLI::App& doctor_command = *app.add_subcommand("doctor", "Is the rig sane? What is wrong with it, and what to do");
  doctor.add_input(doctor_command);
  doctor_command.add_option("--samples", examination.samples, "How many frames to look at (default 40)")
      ->option_text("N")
      ->check(CLI::Range(2, 400));
  doctor_command.add_flag("--json", examination.json, "Print the diagnosis as JSON on standard output");
  doctor_command.footer(kDoctorExamples);

  CLI::App& selftest_command = *app.add_subcommand("selftest", "Accuracy on the synthetic scene: is this build sound?");
  selftest_command.add_option("--scene-frames", selftest.frames, "Frames of the full turn (default 60)")
      ->option_text("N")
      ->check(CLI::Range(1, 100000));
  selftest_command.add_option("--set", selftest.set, "Instructions: baseline, avx2, avx512 or best (default)")
      ->option_text("SET")
      ->check(CLI::IsMember({"best", "baseline", "avx2", "avx512"}));
  selftest_command.add_flag("--json", selftest.json, "Print the result as JSON on standard output");
  selftest_command.add_flag("-q,--quiet", selftest.quiet, "Print what was missed only");

  CLI::App& devices_command = *app.add_subcommand("devices", "The cameras of this machine, by the names that stay");
  devices_command.add_flag("--json", devices.json, "Print them as JSON on standard output");

  CLI::App& bench_command = *app.add_subcommand("bench", "Time of the filter's kernels, for every instruction set");
  bench_command.add_option("--primitives", bench.primitives, "Primitives in the pool (default 1024)")
      ->option_text("N")
      ->check(CLI::Range(1, 1000000));
  bench_command.add_option("--repetitions", bench.repetitions, "Repetitions of each of five rounds (default 7)")
      ->option_text("N")
      ->check(CLI::Range(1, 10000));
  bench_command.add_flag("--json", bench.json, "Print the result as JSON on standard output");
}

ExitStatus Commands::execute(const CLI::App& app) {
  const bool scores_a_file = app.got_subcommand("evaluate") && !evaluation.edges.empty();
  const bool asks_often =
      !scores_a_file && !app.got_subcommand("info") && !app.got_subcommand("devices") && !app.got_subcommand("bench");
  if (asks_often) catch_interrupts();
  if (app.got_subcommand("run")) return run_command(run.options(), command_line);
  if (app.got_subcommand("record")) return record_command(recording.options(record.options()));
  if (app.got_subcommand("info")) return info_command(info.options());
  if (app.got_subcommand("selftest")) return selftest_command(selftest);
  if (app.got_subcommand("devices")) return devices_command(devices);
  if (app.got_subcommand("doctor")) {
    examination.run = doctor.options();
    return doctor_command(examination);
  }
  if (app.got_subcommand("bench")) return bench_command(bench);
  const RunOptions output = evaluation.run;
  evaluation.run = evaluate.options();
  evaluation.run.out = output.out;
  evaluation.run.json = output.json;
  evaluation.run.quiet = output.quiet;
  return evaluate_command(evaluation, command_line);
}

ExitStatus complain(ExitStatus status, const std::string& sentence) {
  print_error("accrete: {}\n", sentence);
  return status;
}

ExitStatus run_parsed(CLI::App& app, Commands& commands, int argc, const char* const* argv) try {
  app.parse(argc, argv);
  return commands.execute(app);
} catch (const CLI::Success& wanted) {  // --help, --version
  std::ostringstream text;
  const int status = app.exit(wanted, text, text);
  print("{}", text.str());
  return static_cast<ExitStatus>(status);
} catch (const CLI::RequiredError& error) {
  if (!app.get_subcommands().empty()) return complain(ExitStatus::kUsage, error.what());
  return complain(ExitStatus::kUsage, fmt::format("there is no command '{}': see accrete --help", argv[1]));
} catch (const CLI::ParseError& error) {
  return complain(ExitStatus::kUsage, fmt::format("{}\nSee accrete --help, or accrete COMMAND --help.", error.what()));
} catch (const Failure& failure) {
  return complain(failure.status(), failure.what());
} catch (const std::bad_alloc&) {
  return complain(ExitStatus::kInput, "not enough memory: close other programs, or choose --capacity small");
} catch (const std::exception& error) {
  return complain(ExitStatus::kInput, error.what());
}

}  // namespace

int run_app(int argc, const char* const* argv) {
  occupy_standard_streams();
  ignore_output_signals();
  CLI::App app{kAbout, "accrete"};
  app.footer(kExamples);
  app.set_version_flag("--version", std::string("accrete ") + kVersion, "Print the version and exit");
  app.require_subcommand(1);
  app.get_formatter()->column_width(30);
  app.get_formatter()->label("REQUIRED", "");
  Commands commands;
  commands.command_line.assign(argv, argv + argc);
  commands.add_to(app);
  if (argc < 2) {
    print_error("{}", app.help());
    return static_cast<int>(
        complain(ExitStatus::kUsage, "say what to do; accrete run alone shows the synthetic scene"));
  }
  ExitStatus status = run_parsed(app, commands, argc, argv);
  // A reader that wants no more, like head, is no error.
  if (const int error = standard_output_error(); error != 0 && error != EPIPE)
    status =
        complain(ExitStatus::kOutput, fmt::format("standard output: {}: what was printed is not all there; send it "
                                                  "elsewhere, or to a disk with room",
                                                  std::strerror(error)));
  return static_cast<int>(status);
}

}  // namespace accrete::cli
