#include "cli/app.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "accrete/version.h"
#include "cli/evaluate/evaluate_command.h"
#include "cli/failure.h"
#include "cli/info.h"
#include "cli/run/interrupt.h"
#include "cli/run/run_command.h"

namespace accrete::cli {
namespace {

constexpr const char* kAbout =
    "accrete accumulates a 3D model of edges from stereo images of something that moves in a known way.";

constexpr const char* kExamples = R"(Examples:
  accrete run                                  the synthetic scene: needs nothing
  accrete run RECORDING                        a folder with images, calibration and poses
  accrete run RECORDING --overlay 5            with pictures of every 5th frame
  accrete run RECORDING --depth-range 0.4:0.9 --exclude-box -0.02,-0.02,0.1,0.02,0.02,0.2
  accrete info RECORDING                       what would be read, and how; computes nothing
  accrete evaluate RECORDING                   accuracy against RECORDING/truth
  accrete selftest                             is this build sound? accuracy on the synthetic scene

Exit status: 0 all frames used, 1 nothing accumulated, 2 wrong command line, 3 results without some of the frames,
4 unreadable input, 5 results not written, 130 interrupted (results written).)";

void add_evaluate_flags(CLI::App& app, EvaluateOptions& options) {
  const char* group = "What to measure and where to write it";
  app.add_option("--hold-out", options.hold_out, "Keep every N-th frame aside and compare the model with it")
      ->check(CLI::Range(2, 1000000))
      ->group(group);
  app.add_option("--truth", options.truth, "Folder with the truth (default RECORDING/truth)")->group(group);
  app.add_option("--edges", options.edges, "Score this edges.csv instead of running")->group(group);
  app.add_option("--judge-above", options.min_existence, "Least existence probability that counts (default 0.9)")
      ->check(CLI::Range(0.0, 1.0))
      ->group(group);
  app.add_option("--markdown", options.markdown, "Write the tables to this Markdown file")->group(group);
  app.add_option("-o,--out", options.run.out, "Write the result files of run there too")->group(group);
  app.add_flag("--json", options.run.json, "Print everything as JSON on standard output")->group(group);
  app.add_flag("-q,--quiet", options.run.quiet, "No progress, no description of the recording")->group(group);
}

}  // namespace

int run_app(int argc, const char* const* argv) {
  install_signal_handlers();
  const std::vector<std::string> command_line(argv, argv + argc);
  CLI::App app{kAbout, "accrete"};
  app.footer(kExamples);
  app.set_version_flag("--version", std::string("accrete ") + kVersion);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);

  RunFlags run_flags, info_flags, evaluate_flags;
  CLI::App* const run = app.add_subcommand("run", "Accumulate a model from a recording and write it");
  run_flags.add_input(*run);
  run_flags.add_accumulation(*run);
  run_flags.add_output(*run);
  CLI::App* const info = app.add_subcommand("info", "Say what would be read, and with which conventions");
  info_flags.add_input(*info);
  CLI::App* const evaluate = app.add_subcommand("evaluate", "Accumulate and score against the truth or unseen images");
  evaluate_flags.add_input(*evaluate);
  evaluate_flags.add_accumulation(*evaluate);
  EvaluateOptions evaluation;
  add_evaluate_flags(*evaluate, evaluation);

  try {
    app.parse(argc, argv);
    ExitStatus status = ExitStatus::kOk;
    if (run->parsed()) status = run_command(run_flags.options(), command_line);
    if (info->parsed()) status = info_command(info_flags.options());
    if (evaluate->parsed()) {
      const RunOptions output = evaluation.run;
      evaluation.run = evaluate_flags.options();
      evaluation.run.out = output.out;
      evaluation.run.json = output.json;
      evaluation.run.quiet = output.quiet;
      status = evaluate_command(evaluation, command_line);
    }
    return static_cast<int>(status);
  } catch (const CLI::Success& wanted) {  // --help, --version
    return app.exit(wanted);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "accrete: {}\nSee accrete --help, or accrete COMMAND --help.\n", error.what());
    return static_cast<int>(ExitStatus::kUsage);
  } catch (const Failure& failure) {
    fmt::print(stderr, "accrete: {}\n", failure.what());
    return static_cast<int>(failure.status());
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "accrete: not enough memory: close other programs, or choose --capacity small\n");
    return static_cast<int>(ExitStatus::kInput);
  } catch (const std::exception& error) {
    fmt::print(stderr, "accrete: {}\n", error.what());
    return static_cast<int>(ExitStatus::kInput);
  }
}

}  // namespace accrete::cli
