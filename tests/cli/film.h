// A short recording in memory, for tests that break it.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "accrete/hal/recording.h"
#include "accrete/hal/synthetic.h"
#include "cli/doctor/doctor_command.h"

namespace accrete::cli {

struct FilmFrame {
  GreyImage left, right;
  Motion motion;
};

struct Film {
  std::int64_t right_later_ns = 0;  // by the stamps
  StereoRig rig;
  MotionMode mode = MotionMode::kObjectMoves;
  bool has_poses = true;
  int calibrated_width_px = 0, calibrated_height_px = 0;
  std::vector<FilmFrame> frames;
};

inline Timestamp film_time(std::size_t frame) { return {static_cast<std::int64_t>(frame) * 33'333'333}; }

class FilmSource final : public hal::StereoSource {
 public:
  explicit FilmSource(const Film& film) : film_(film) { rig_ = film.rig; }
  [[nodiscard]] std::uint64_t size() const override { return film_.frames.size(); }

 private:
  hal::Outcome do_configure() override { return {}; }
  hal::Outcome do_start() override { return {}; }
  hal::Outcome do_acquire(std::int64_t /*timeout_ns*/, StereoFrame& frame) override {
    if (next_ == film_.frames.size()) return {Status::kEndOfStream, "the film is over"};
    const auto view = [](const GreyImage& image) {
      return ImageView{image.pixels.data(), image.width_px, image.height_px, image.width_px, PixelFormat::kGrey8};
    };
    frame.left = view(film_.frames[next_].left);
    frame.right = view(film_.frames[next_].right);
    frame.t_left = film_time(next_);
    frame.t_right = {frame.t_left.ns + film_.right_later_ns};
    frame.sequence = next_++;
    return {};
  }

  const Film& film_;
  std::size_t next_ = 0;
};

class FilmMotion final : public hal::MotionSource {
 public:
  explicit FilmMotion(const Film& film) : film_(film) {}
  hal::Outcome at(Timestamp t, Motion& motion) override {
    for (std::size_t i = 0; i < film_.frames.size(); ++i)
      if (film_time(i) == t) {
        motion = film_.frames[i].motion;
        return {};
      }
    return {Status::kNotFound, "no pose"};
  }

 private:
  const Film& film_;
};

// The frames `numbers` of a source, each of them once and in rising order.
inline void take(hal::StereoSource& source, hal::MotionSource* motion, const std::vector<std::uint64_t>& numbers,
                 Film& film) {
  film.rig = source.rig();
  film.has_poses = motion != nullptr;
  ASSERT_TRUE(source.start().ok());
  StereoFrame frame;
  for (std::size_t next = 0; next < numbers.size() && source.acquire(0, frame).ok(); source.release()) {
    if (frame.sequence != numbers[next]) continue;
    ++next;
    film.frames.push_back({to_grey(frame.left), to_grey(frame.right), {}});
    if (motion != nullptr) {
      ASSERT_TRUE(motion->at(frame.t_left, film.frames.back().motion).ok());
    }
    film.mode = film.frames.back().motion.mode;
  }
}

inline Film film_of_scene(const char* name, int frames, const std::vector<std::uint64_t>& numbers) {
  Film film;
  std::unique_ptr<hal::StereoSource> stereo;
  std::unique_ptr<hal::MotionSource> motion;
  hal::SyntheticOptions options;
  options.frames = frames;
  EXPECT_TRUE(hal::open_synthetic(name, options, stereo, motion).ok());
  if (stereo->state() == hal::StereoSource::SourceState::kClosed) {
    EXPECT_TRUE(stereo->configure().ok());
  }
  take(*stereo, motion.get(), numbers, film);
  return film;
}

inline Diagnosis examine(const Film& film) {
  Input input;
  auto source = std::make_unique<FilmSource>(film);
  EXPECT_TRUE(source->configure().ok());
  input.source = std::move(source);
  if (film.has_poses) input.motion = std::make_unique<FilmMotion>(film);
  input.mode = film.mode;
  if (film.calibrated_width_px > 0) {
    input.info.emplace();
    input.info->calibrated_width_px = film.calibrated_width_px;
    input.info->calibrated_height_px = film.calibrated_height_px;
  }
  return examine(input, {});
}

}  // namespace accrete::cli
