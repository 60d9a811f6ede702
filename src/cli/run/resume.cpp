#include "cli/run/resume.h"

#include <fmt/format.h>

#include "accrete/contract.h"
#include "cli/failure.h"
#include "cli/text/file.h"

namespace accrete::cli {
namespace {

std::span<const std::byte> view(const std::string& bytes) { return std::as_bytes(std::span(bytes)); }

std::filesystem::path file_in(const std::filesystem::path& path) {
  std::error_code unknown;
  return std::filesystem::is_directory(path, unknown) ? path / kModelFile : path;
}

template <class Limits>
bool is_profile(const Capacities& c) {
  return c == Accumulator<Limits>::kCapacities;
}

}  // namespace

SavedModel::SavedModel(const std::filesystem::path& path) : file_(file_in(path)), bytes_(read_text_file(file_)) {
  const SavedModelFault fault = read_saved_model_info(view(bytes_), info_);
  if (fault != SavedModelFault::kNone)
    throw Failure(ExitStatus::kInput, fmt::format("{}: {}", file_.string(), to_string(fault)));
}

Capacity SavedModel::capacity(Capacity wanted) const {
  const Capacities& c = info_.capacities;
  Capacity own = Capacity::kAuto;
  if (is_profile<SmallLimits>(c)) own = Capacity::kSmall;
  if (is_profile<DefaultLimits>(c)) own = Capacity::kDefault;
  if (is_profile<LargeLimits>(c)) own = Capacity::kLarge;
  if (own == Capacity::kAuto)
    throw Failure(
        ExitStatus::kInput,
        fmt::format("{}: it was saved by a program with limits of its own ({} primitives, images of {} x {}); "
                    "this one has the profiles small, default and large",
                    file_.string(), c.primitives3d, c.image_width, c.image_height));
  if (wanted != Capacity::kAuto && wanted != own)
    throw Failure(ExitStatus::kUsage, fmt::format("{}: it was saved with --capacity {}, and goes on with no other",
                                                  file_.string(), to_string(own)));
  return own;
}

void SavedModel::into(Engine& engine, Timestamp first) const {
  const bool later = info_.has_times && info_.last < first;
  const RestoreReport report =
      engine.restore(view(bytes_), later ? RestoredClock::kGoesOn : RestoredClock::kStartsAnew);
  if (report.status != Status::kOk)
    throw Failure(ExitStatus::kInput, fmt::format("{}: {}", file_.string(), to_string(report.fault)));
}

std::string SavedModel::line() const {
  return fmt::format("{}: {} primitives of {} frames, saved", file_.string(), info_.primitives, info_.frames);
}

std::string saved(const Engine& engine) {
  std::string bytes(engine.saved_bytes(), '\0');
  const Status status = engine.save(std::as_writable_bytes(std::span(bytes)));
  ACCRETE_EXPECTS(status == Status::kOk);  // it is configured, and the size is its own
  return bytes;
}

}  // namespace accrete::cli
