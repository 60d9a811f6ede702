#include "cli/doctor/samples.h"

#include <algorithm>

#include "cli/failure.h"

namespace accrete::cli {
namespace {

constexpr std::int64_t kPatienceNs = 5'000'000'000;  // for a frame of a live camera

std::optional<Motion> motion_at(hal::MotionSource* motion, Timestamp t) {
  Motion m;
  if (motion == nullptr || !motion->at(t, m).ok()) return std::nullopt;
  return m;
}

Sample make_sample(const StereoFrame& frame) {
  Sample sample;
  sample.number = frame.sequence;
  sample.t_left = frame.t_left;
  sample.t_right = frame.t_right;
  sample.left = find_landmarks(to_grey(frame.left));
  sample.right = find_landmarks(to_grey(frame.right));
  sample.stereo = pair_landmarks(sample.left, sample.right);
  return sample;
}

bool consecutive(const Sample& a, const Sample& b) { return b.number == a.number + 1; }

// The motion of the frames beside each sample: known by the time of every frame that was passed.
void add_motions(Samples& samples, hal::MotionSource* motion, const std::vector<Timestamp>& times,
                 std::uint64_t first) {
  for (Sample& sample : samples.list) {
    const std::uint64_t i = sample.number - first;
    sample.motion = motion_at(motion, sample.t_left);
    if (motion != nullptr && !sample.motion) ++samples.without_motion;
    if (i > 0 && i - 1 < times.size()) sample.motion_before = motion_at(motion, times[static_cast<std::size_t>(i - 1)]);
    if (i + 1 < times.size()) sample.motion_after = motion_at(motion, times[static_cast<std::size_t>(i + 1)]);
  }
}

}  // namespace

std::vector<std::uint64_t> choose_frames(std::uint64_t first, std::uint64_t count, std::uint64_t wanted) {
  std::vector<std::uint64_t> frames;
  if (count <= wanted || wanted < 2) {
    for (std::uint64_t i = 0; i < std::min(count, wanted); ++i) frames.push_back(first + i);
    return frames;
  }
  const std::uint64_t runs = wanted / 2;
  for (std::uint64_t i = 0; i < runs; ++i) {
    const std::uint64_t begin = runs == 1 ? 0 : i * (count - 2) / (runs - 1);
    for (const std::uint64_t frame : {first + begin, first + begin + 1})
      if (frames.empty() || frame > frames.back()) frames.push_back(frame);
  }
  return frames;
}

Samples take_samples(hal::StereoSource& source, hal::MotionSource* motion, const FrameRange& range,
                     std::uint64_t wanted, const std::function<bool()>& stopped) {
  if (source.state() != hal::StereoSource::SourceState::kStreaming)
    if (const hal::Outcome started = source.start(); !started.ok()) throw Failure(ExitStatus::kInput, started.message);
  const std::uint64_t size = source.size();
  const std::uint64_t last = size == 0 ? range.last : std::min(range.last, size - 1);
  const bool known = size > 0 && last >= range.first;
  const std::vector<std::uint64_t> chosen =
      known ? choose_frames(range.first, last - range.first + 1, wanted) : std::vector<std::uint64_t>{};

  Samples samples;
  std::vector<Timestamp> times;  // of the frames from range.first on; a lost frame has that of the one after it
  std::uint64_t failures = 0;
  for (bool more = true; more && !stopped();) {
    StereoFrame frame;
    const hal::Outcome got = source.acquire(kPatienceNs, frame);
    if (got.status == Status::kEndOfStream) break;
    if (!got.ok()) {
      if (++samples.unreadable == 1) samples.why_unreadable = got.message;
      if (got.status != Status::kDataLoss || ++failures > 1000) {
        if (samples.list.empty()) throw Failure(ExitStatus::kInput, got.message);
        break;
      }
      continue;
    }
    ++samples.frames;
    const std::uint64_t number = frame.sequence;
    if (number >= range.first) times.resize(static_cast<std::size_t>(number - range.first + 1), frame.t_left);
    const bool wants = known ? std::binary_search(chosen.begin(), chosen.end(), number) : range.contains(number);
    if (wants) samples.list.push_back(make_sample(frame));
    source.release();
    more = known ? number <= last && (chosen.empty() || number <= chosen.back()) : samples.list.size() < wanted;
  }
  source.stop();
  for (std::size_t i = 0; i + 1 < samples.list.size(); ++i) {
    Sample& sample = samples.list[i];
    sample.has_next = consecutive(sample, samples.list[i + 1]);
    if (sample.has_next) sample.next = pair_landmarks(sample.left, samples.list[i + 1].left);
  }
  add_motions(samples, motion, times, range.first);
  return samples;
}

}  // namespace accrete::cli
