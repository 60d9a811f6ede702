#include "cli/run/run_command.h"

#include <fmt/format.h>

#include <chrono>
#include <optional>

#include "cli/run/accumulate.h"
#include "cli/run/overlay_writer.h"
#include "cli/run/results.h"
#include "cli/run/resume.h"
#include "cli/text/json_text.h"
#include "cli/text/print.h"
#include "cli/write/snapshot.h"

namespace accrete::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// The numbers that everybody wants, at the end.
void print_result(const RunRecord& run, const ordered_json& result, const ResultFolder& folder) {
  const ordered_json& p = result["primitives"];
  const ordered_json& t = result["timing_ms"];
  print("frames       {} used", run.count(FrameFate::kUsed));
  if (run.lost() > 0)
    print(", {} not: {} unreadable, {} without a pose, {} refused", run.lost(), run.count(FrameFate::kUnreadable),
          run.count(FrameFate::kNoPose), run.count(FrameFate::kRefused));
  print("\nmodel        {} confirmed, {} preserved (hidden now), {} tentative\n", p["confirmed"].get<std::size_t>(),
        p["preserved"].get<std::size_t>(), p["tentative"].get<std::size_t>());
  if (t["step"]["n"] > 0) {
    print("time         {:.2f} ms a frame in the median:", t["step"]["p50"].get<double>());
    for (int i = 0; i < kStageCount; ++i) {
      const char* stage = to_string(static_cast<Stage>(i));
      print("{} {} {:.2f}", i > 0 ? "," : "", stage, t[stage]["p50"].get<double>());
    }
    print("\n");
  }
  print(
      "results      {}/\n             edges.csv, edges.ply, lines.ply, ribbons.ply (open this one in any viewer), "
      "summary.json, "
      "config.yaml\n",
      folder.path().string());
}

void warn(const std::string& sentence) { print_error("warning: {}\n", sentence); }

// What an earlier run left in the same folder and this one does not replace: it could be taken for this one's.
std::vector<std::string> left_over(const ResultFolder& folder, const RunOptions& options) {
  std::vector<std::string> sentences;
  std::error_code unknown;
  if (const fs::path model = folder.path() / kModelFile; !options.save_model && fs::exists(model, unknown))
    sentences.push_back(fmt::format("{} is of an earlier run: --save-model replaces it", model.string()));
  if (const fs::path pictures = folder.path() / kOverlayFolder;
      options.overlay_every == 0 && fs::exists(pictures, unknown))
    sentences.push_back(fmt::format(
        "{} has pictures of an earlier run: delete them, or choose another folder with --out", pictures.string()));
  return sentences;
}

const char* nothing_sentence(const RunRecord& run) {
  if (run.count(FrameFate::kUsed) == 0) return "no frame could be used; see the warnings above";
  if (run.count(FrameFate::kUsed) < 4)
    return "too few frames: a primitive is confirmed when it has been seen from several sides; use more frames";
  return "no primitive was confirmed: does the given motion belong to these images (accrete info shows how it was "
         "read; "
         "--motion, --pose-dir and --pose-frame change it), and is the object in the depth range?";
}

}  // namespace

ExitStatus run_command(const RunOptions& given, const std::vector<std::string>& command_line) {
  const auto begin = std::chrono::steady_clock::now();
  RunOptions options = given;
  Input input = open_input(options);
  options.params = effective_params(options, input);
  std::optional<SavedModel> earlier;
  if (!options.resume.empty()) options.capacity = earlier.emplace(options.resume).capacity(options.capacity);
  const std::unique_ptr<Engine> engine = make_engine(input.source->rig(), options.params, options.capacity);
  if (earlier) earlier->into(*engine, earlier->info().last);  // refused before any work is done
  if (!options.out.empty()) refuse_as_results(options.out, input, {});
  const ResultFolder folder(options.out, input.name);
  const std::vector<std::string> stale = left_over(folder, options);

  const bool talk = !options.quiet && !options.json;
  if (talk)
    for (const std::string& line : describe(input)) print("{}\n", line);
  if (talk && earlier) print("goes on with {}\n", earlier->line());
  flush_output();
  for (const std::string& warning : input.warnings) warn(warning);

  Progress progress(stderr, expected_frames(input, options), options.quiet);
  OverlayWriter overlays(folder, input.source->rig(), options.overlay_every);
  LoopHooks hooks;
  if (earlier) hooks.first = [&](Timestamp first) { earlier->into(*engine, first); };
  hooks.accumulated = [&](const FrameContext& c) { overlays.frame(c); };
  RunRecord run = accumulate(input, *engine, options, progress, hooks);
  if (run.motion_covariance_is_default) warn(run.warnings.back());
  for (const std::string& sentence : stale) {
    run.warnings.push_back(sentence);
    warn(sentence);
  }
  if (overlays.failure()) {
    run.warnings.push_back(std::string("no more overlays: ") + overlays.failure()->what());
    warn(run.warnings.back());
  }
  if (input.live_poses != nullptr) {
    const hal::LiveMotionCounters c = input.live_poses->counters();
    const std::string sentence = input.live_poses->name() + ": " + live_poses_sentence(c);
    if (c.malformed + c.backwards + c.late + c.interrupted + c.early + c.missing > 0) {
      run.warnings.push_back(sentence);
      warn(sentence);
    } else if (talk) {
      print("poses        {}\n", live_poses_sentence(c));
    }
  }
  if (const std::string unlinked = folder.link_latest(); !unlinked.empty()) {
    run.warnings.push_back(unlinked);
    warn(unlinked);
  }

  const std::vector<Primitive3d> primitives = snapshot(engine->model(), run.used);
  const std::vector<Primitive3d> exported = accepted(primitives, options.min_existence);
  ExitStatus status = exit_status_of(run, accepted(primitives, 0).size());
  if (status == ExitStatus::kNothing) run.warnings.push_back(nothing_sentence(run));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const ordered_json result =
      summary({command_line, options, input, *engine, run, primitives, exported.size(), status, seconds});

  write_results(folder, options, input.mode, primitives, exported, result);
  if (options.save_model) folder.write(kModelFile, saved(*engine));

  if (options.json) print("{}", json_text(result));
  if (talk) print_result(run, result, folder);
  if (run.interrupted) warn("interrupted; the results are those of the frames so far");
  if (status == ExitStatus::kNothing) print_error("accrete: {}\n", nothing_sentence(run));
  if (overlays.failure()) status = ExitStatus::kOutput;
  return status;
}

}  // namespace accrete::cli
