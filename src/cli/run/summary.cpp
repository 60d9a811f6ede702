#include "cli/run/summary.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include <ctime>
#include <fstream>

#include "accrete/instruction_set.h"
#include "accrete/version.h"
#include "cli/run/configuration.h"
#include "cli/run/counters.h"
#include "cli/score/statistics.h"
#include "cli/write/snapshot.h"

namespace accrete::cli {
namespace {

using nlohmann::ordered_json;

ordered_json spread(const std::vector<double>& ms) {
  if (ms.empty())
    return {{"n", 0},         {"mean", nullptr}, {"p50", nullptr}, {"p90", nullptr},
            {"p95", nullptr}, {"p99", nullptr},  {"max", nullptr}};
  return {{"n", ms.size()},
          {"mean", mean(ms)},
          {"p50", percentile(ms, 50)},
          {"p90", percentile(ms, 90)},
          {"p95", percentile(ms, 95)},
          {"p99", percentile(ms, 99)},
          {"max", percentile(ms, 100)}};
}

// A processor's name, never a host's. ARM's /proc/cpuinfo has no "model name"; its "CPU part" says little alone.
std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos && (line.starts_with("model name") || line.starts_with("Model\t")))
      return line.substr(colon + 2);
  }
  return "unknown";
}

}  // namespace

ordered_json versions() {
#if defined(__clang__)
  const char* compiler = "clang " __clang_version__;
#else
  const char* compiler = "gcc " __VERSION__;
#endif
  return {{"accrete", kVersion},
          {"compiler", compiler},
          {"cplusplus", __cplusplus},
          {"processor", processor()},
          {"instruction_set", name(InstructionSet::kBest)}};
}

namespace {

ordered_json camera_json(const Camera& c) {
  return {{"width_px", c.width_px}, {"height_px", c.height_px}, {"fx_px", c.fx_px},
          {"fy_px", c.fy_px},       {"cx_px", c.cx_px},         {"cy_px", c.cy_px}};
}

ordered_json recording_json(const Input& input) {
  ordered_json out{{"name", input.name}, {"kind", input.kind}, {"frame", frame_text(input.mode)}};
  const StereoRig& rig = input.source->rig();
  out["rig"] = {{"left", camera_json(rig.left)}, {"right", camera_json(rig.right)}, {"baseline_m", rig.baseline_m()}};
  if (input.info && !input.cameras)
    out["found"] = {{"frames", input.info->frames},
                    {"left_only", input.info->left_only},
                    {"right_only", input.info->right_only},
                    {"image_format", input.info->image_format},
                    {"image_channels", input.info->image_channels},
                    {"image_bits", input.info->image_bits},
                    {"poses", input.info->poses},
                    {"frames_with_pose", input.info->frames_with_pose}};
  out["guesses"] = input.guesses;
  return out;
}

ordered_json frames_json(const RunRecord& run) {
  ordered_json out{{"recording", run.recording_frames > 0 ? ordered_json(run.recording_frames) : ordered_json(nullptr)},
                   {"seen", run.frames.size()}};
  for (const FrameFate fate :
       {FrameFate::kUsed, FrameFate::kUnreadable, FrameFate::kNoPose, FrameFate::kRefused, FrameFate::kHeldOut})
    out[to_string(fate)] = run.count(fate);
  return out;
}

ordered_json totals(const RunRecord& run) {
  ordered_json out = ordered_json::object();
  for (const FrameRecord& f : run.frames)
    for_each_counter(f.report, [&out](const char* name, std::uint32_t value) {
      out[name] = out.value(name, std::uint64_t{0}) + value;
    });
  return out;
}

double rounded(double ms) { return std::round(ms * 1e4) / 1e4; }  // 0.1 microseconds: the clock's own noise is larger

// One array for each column, all of the same length: a table.
ordered_json per_frame(const RunRecord& run) {
  ordered_json out{{"frame", ordered_json::array()}, {"t_ns", ordered_json::array()}, {"fate", ordered_json::array()}};
  for (const FrameRecord& f : run.frames) {
    out["frame"].push_back(f.number);
    out["t_ns"].push_back(f.t_ns);
    out["fate"].push_back(to_string(f.fate));
    const auto put = [&out](const char* name, std::uint32_t value) { out[name].push_back(value); };
    for_each_counter(f.report, put);
    for_each_level(f.report, put);
    out["read_ms"].push_back(rounded(f.read_ms));
    for (std::size_t i = 0; i < kStageCount; ++i)
      out[std::string(to_string(static_cast<Stage>(i))) + "_ms"].push_back(rounded(f.stage_ms[i]));
    out["step_ms"].push_back(rounded(f.step_ms));
  }
  return out;
}

std::uint64_t peak_resident_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // kibibytes on Linux
}

}  // namespace

ordered_json timing(const RunRecord& run) {
  std::array<std::vector<double>, kStageCount> stages;
  std::vector<double> step, read;
  for (const FrameRecord& f : run.frames) {
    if (f.fate != FrameFate::kUsed) continue;
    for (std::size_t i = 0; i < kStageCount; ++i) stages[i].push_back(f.stage_ms[i]);
    step.push_back(f.step_ms);
    read.push_back(f.read_ms);
  }
  ordered_json out;
  for (std::size_t i = 0; i < kStageCount; ++i) out[to_string(static_cast<Stage>(i))] = spread(stages[i]);
  out["step"] = spread(step);
  out["read"] = spread(read);
  return out;
}

ExitStatus exit_status_of(const RunRecord& run, std::size_t accepted) {
  if (accepted == 0) return ExitStatus::kNothing;
  if (run.interrupted) return ExitStatus::kInterrupted;
  return run.lost() > 0 ? ExitStatus::kPartial : ExitStatus::kOk;
}

ordered_json summary(const SummaryInput& s) {
  std::size_t tentative = 0, confirmed = 0, preserved = 0;
  for (const Primitive3d& p : s.primitives) {
    tentative += p.state == State::kTentative ? 1 : 0;
    confirmed += p.state == State::kConfirmed ? 1 : 0;
    preserved += p.state == State::kPreserved ? 1 : 0;
  }
  ordered_json out;
  out["schema"] = "accrete-summary-1";
  out["versions"] = versions();
  out["command_line"] = s.command_line;
  out["written_utc"] = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  out["exit_status"] = static_cast<int>(s.status);
  out["interrupted"] = s.run.interrupted;
  out["recording"] = recording_json(s.input);
  out["configuration"] = configuration(s.options, s.input, s.engine);
  out["frames"] = frames_json(s.run);
  out["primitives"] = {
      {"tentative", tentative}, {"confirmed", confirmed}, {"preserved", preserved}, {"exported", s.exported}};
  out["counts"] = totals(s.run);
  out["threads"] = s.run.threads;
  out["timing_ms"] = timing(s.run);
  out["wall_seconds"] = s.wall_seconds;
  out["memory"] = {{"accumulator_bytes", s.engine.bytes()}, {"peak_resident_bytes", peak_resident_bytes()}};
  std::vector<std::string> warnings = s.input.warnings;
  warnings.insert(warnings.end(), s.run.warnings.begin(), s.run.warnings.end());
  out["warnings"] = warnings;
  if (s.run.cameras) out["cameras"] = statistics_json(*s.run.cameras);
  out["per_frame"] = per_frame(s.run);
  return out;
}

}  // namespace accrete::cli
