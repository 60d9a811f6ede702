#include "cli/evaluate/evaluate_command.h"

#include <fmt/format.h>

#include <chrono>
#include <optional>

#include "accrete/version.h"
#include "cli/evaluate/evaluation.h"
#include "cli/evaluate/markdown_page.h"
#include "cli/run/results.h"
#include "cli/text/file.h"
#include "cli/text/json_text.h"
#include "cli/text/print.h"
#include "cli/write/snapshot.h"

namespace accrete::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::string_view kOtherPage = "; name another file with --markdown";

// Of a path with or without a slash at the end.
std::string last_name(const std::string& word) {
  const fs::path path(word);
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : " ") + last_name(word);
  return out;
}

std::string text_if_there(const fs::path& file) {
  std::error_code error;
  return fs::exists(file, error) ? read_text_file(file) : "";
}

void publish(const ordered_json& result, const EvaluateOptions& options, const std::vector<std::string>& command_line) {
  const std::vector<Table> tables = evaluation_tables(result);
  if (options.run.json) {
    print("{}", json_text(result));
  } else {
    print("{}", to_text(tables));
  }
  if (options.markdown.empty()) return;
  const std::string page = text_if_there(options.markdown);
  const std::string body = fmt::format("`{}`, accrete {}\n{}", joined(command_line), kVersion, to_markdown(tables));
  write_file(options.markdown, with_section(page, result["recording"].get<std::string>(), body), kOtherPage);
}

// The truth folder that was named, or the input's own.
Truth choose_truth(const EvaluateOptions& options, const Input& input) {
  if (options.truth.empty()) return truth_of(input, options.run);
  std::error_code error;
  if (!fs::is_directory(options.truth, error))
    throw Failure(ExitStatus::kInput,
                  fmt::format("{}: is no folder; --truth needs one with edges.csv in it", options.truth.string()));
  return read_truth(options.truth);
}

ExitStatus score_file(const EvaluateOptions& options, const std::vector<std::string>& command_line) {
  Truth truth;
  if (options.truth.empty() && !synthetic_name(options.run.recording)) {
    truth = read_truth(truth_folder_of(options.run.recording));
  } else {
    RunOptions run = options.run;
    run.input.require_poses = false;
    truth = options.truth.empty() ? truth_of(open_input(run), run) : read_truth(options.truth);
  }
  if (!truth.edges)
    throw Failure(ExitStatus::kInput,
                  fmt::format("{}: has no truth/edges.csv to score against", options.run.recording));
  std::vector<std::string> notes;
  const ScoredEdges edges = parse_edges(read_text_file(options.edges), options.edges.string(), notes);
  ScoreSettings settings;
  settings.min_existence = options.min_existence;
  ordered_json result{{"recording", name_of_recording(options.run.recording)}};
  result["score"] = score(edges, truth, settings, notes);
  publish(result, options, command_line);
  return ExitStatus::kOk;
}

}  // namespace

ExitStatus evaluate_command(const EvaluateOptions& given, const std::vector<std::string>& command_line) {
  if (given.run.recording.starts_with(kV4l2Prefix))
    throw Failure(ExitStatus::kUsage,
                  fmt::format("{}: what a camera sees has no truth; evaluate a recording", given.run.recording));
  if (!given.edges.empty()) {
    if (!given.run.out.empty() || given.hold_out > 0)
      throw Failure(ExitStatus::kUsage,
                    "--edges scores a file and runs nothing: --out and --hold-out have no place here");
    return score_file(given, command_line);
  }
  const auto begin = std::chrono::steady_clock::now();
  EvaluateOptions options = given;
  options.run.full_covariance = true;  // the NEES needs it
  Input input = open_input(options.run);
  options.run.params = effective_params(options.run, input);
  Truth truth = choose_truth(options, input);
  const fs::path rig_file = input.info ? input.info->root / "rig.txt" : fs::path();
  const std::string sources = !rig_file.empty() ? text_if_there(rig_file) : "";
  HoldOutPlan plan = plan_hold_out(options.hold_out, input.source->size(), sources, rig_file.string());
  if (options.hold_out > 0 && plan.held.empty())
    throw Failure(ExitStatus::kUsage, fmt::format("--hold-out {}: the recording has only {} frames", options.hold_out,
                                                  input.source->size()));
  const std::unique_ptr<Engine> engine = make_engine(input.source->rig(), options.run.params, options.run.capacity);
  std::optional<ResultFolder> folder;
  if (!options.run.out.empty()) {
    refuse_as_results(options.run.out, input, options.truth);
    folder.emplace(options.run.out, input.name);
  }
  if (!options.markdown.empty())  // fails now, not at the end
    write_file(options.markdown, text_if_there(options.markdown), kOtherPage);

  const bool talk = !options.run.quiet && !options.run.json;
  if (talk)
    for (const std::string& line : describe(input)) print("{}\n", line);
  flush_output();
  for (const std::string& warning : input.warnings) print_error("warning: {}\n", warning);
  if (!truth.edges && !truth.bbox && plan.held.empty())
    print_error(
        "warning: {} has no truth/edges.csv and no truth/bbox.txt: only counts and times; --hold-out N "
        "compares the model with images that it has not seen\n",
        input.name);

  ScoreSettings settings;
  settings.min_existence = options.min_existence;
  const std::uint64_t frames = expected_frames(input, options.run);
  const std::uint64_t aside = plan.held.size() + plan.shared.size();
  Evaluation evaluation(input, options.run, std::move(truth), std::move(plan), settings,
                        frames > aside ? frames - aside : 0);
  Progress progress(stderr, frames, options.run.quiet);
  const RunRecord run = accumulate(input, *engine, options.run, progress, evaluation.hooks());
  const std::vector<Primitive3d> primitives = snapshot(engine->model(), run.used);
  const std::size_t model_size = accepted(primitives, 0).size();
  const ExitStatus status = exit_status_of(run, model_size);
  publish(evaluation.result(run, primitives), options, command_line);
  if (folder) {
    const std::vector<Primitive3d> exported = accepted(primitives, options.run.min_existence);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    write_results(
        *folder, options.run, input.mode, primitives, exported,
        summary({command_line, options.run, input, *engine, run, primitives, exported.size(), status, seconds}));
  }
  if (model_size == 0) print_error("accrete: nothing was accumulated\n");
  return status;
}

}  // namespace accrete::cli
