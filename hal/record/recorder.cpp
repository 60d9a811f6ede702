#include "accrete/hal/recorder.h"

#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "image/image_file.h"
#include "record/disk.h"
#include "record/frame_queue.h"
#include "record/make_recorder.h"
#include "record/recording_writer.h"
#include "text/parse.h"
#include "text/sentence.h"

namespace accrete::hal {
namespace {

class ThreadedRecorder final : public Recorder {
 public:
  ThreadedRecorder(std::unique_ptr<Disk> disk, std::unique_ptr<RecordingWriter> writer,
                   const RecorderSettings& settings)
      : disk_(std::move(disk)),
        writer_(std::move(writer)),
        wait_(settings.wait_when_full),
        queue_(settings.buffer_bytes),
        thread_([this] { write(); }) {}
  ~ThreadedRecorder() override { (void)finish(); }
  ThreadedRecorder(const ThreadedRecorder&) = delete;
  ThreadedRecorder& operator=(const ThreadedRecorder&) = delete;

  Status record(const StereoFrame& frame) override {
    if (Status status = admit(frame); status != Status::kOk) return status;
    const Status status = queue_.put(frame, wait_);
    if (status == Status::kCapacityExceeded) {
      const std::scoped_lock lock(mutex_);
      ++counters_.dropped;
    }
    return status;
  }

  Outcome finish() override {
    if (thread_.joinable()) {
      queue_.close(false);
      thread_.join();
    }
    return ended_;
  }

  [[nodiscard]] RecorderCounters counters() const override {
    RecorderCounters counters;
    {
      const std::scoped_lock lock(mutex_);
      counters = counters_;
    }
    counters.capacity = queue_.capacity();
    counters.most_waiting = queue_.most_waiting();
    return counters;
  }

 private:
  // The reader refuses a time that occurs twice, and pairs are in order.
  Status admit(const StereoFrame& frame) {
    const auto fits = [](const ImageView& image) {
      return image.valid() && image.width_px <= kMaxImageSide_px && image.height_px <= kMaxImageSide_px;
    };
    const std::scoped_lock lock(mutex_);
    ++counters_.offered;
    const bool later = !last_left_ || (frame.t_left > *last_left_ && frame.t_right > *last_right_);
    if (!later || !fits(frame.left) || !fits(frame.right) || !is_stamp(frame.t_left.ns) ||
        !is_stamp(frame.t_right.ns)) {
      ++counters_.refused;
      return Status::kInvalidArgument;
    }
    last_left_ = frame.t_left;
    last_right_ = frame.t_right;
    return Status::kOk;
  }

  void write() {
    Outcome o;
    try {
      while (const QueuedFrame* queued = queue_.front()) {
        o = writer_->write(queued->frame, queued->taken);
        queue_.done();
        {
          const std::scoped_lock lock(mutex_);
          counters_.written = writer_->frames();
          counters_.without_pose = writer_->without_pose();
          counters_.bytes = writer_->bytes();
        }
        if (!o.ok()) break;
      }
      if (o.ok()) o = writer_->end();
    } catch (const std::exception& e) {  // no memory
      o = {Status::kUnavailable, std::string("the recording ended: ") + e.what()};
    }
    queue_.close(true);
    if (!o.ok())
      o.message += "; " + count(writer_->frames(), "frame") + (writer_->frames() == 1 ? " is" : " are") +
                   " complete and can be replayed. Free some space or choose another disk, then record again";
    ended_ = std::move(o);
  }

  std::unique_ptr<Disk> disk_;
  std::unique_ptr<RecordingWriter> writer_;  // of the thread alone
  bool wait_;
  FrameQueue queue_;
  mutable std::mutex mutex_;
  RecorderCounters counters_;                        // under the mutex
  std::optional<Timestamp> last_left_, last_right_;  // under the mutex
  Outcome ended_;                                    // of the thread until it has ended
  std::thread thread_;                               // last: it uses all of the above
};

Outcome check(const RecorderSettings& s) {
  if (s.sync_period_ns < 0)
    return {Status::kInvalidArgument, "the recorder's sync period must be zero or more (--sync)"};
  if (s.pose_wait_ns < 0) return {Status::kInvalidArgument, "the wait for a pose must be zero or more (--pose-wait)"};
  if (!supported(ImageFormat::kPng))
    return {Status::kUnsupported,
            "recordings are PNG images, which this build leaves out: configure with -DACCRETE_WITH_PNG=ON"};
  return {};
}

}  // namespace

Outcome make_recorder(std::unique_ptr<Disk> disk, const std::filesystem::path& folder, const StereoRig& rig,
                      MotionSource* motion, const RecorderSettings& settings, std::unique_ptr<Recorder>& recorder) {
  recorder.reset();
  if (Outcome o = check(settings); !o.ok()) return o;
  auto writer = std::make_unique<RecordingWriter>(*disk, folder, rig, motion, settings);
  if (Outcome o = writer->begin(); !o.ok()) return o;
  recorder = std::make_unique<ThreadedRecorder>(std::move(disk), std::move(writer), settings);
  return {};
}

Outcome make_recorder(const std::filesystem::path& folder, const StereoRig& rig, MotionSource* motion,
                      const RecorderSettings& settings, std::unique_ptr<Recorder>& recorder) {
  return make_recorder(make_disk(), folder, rig, motion, settings, recorder);
}

}  // namespace accrete::hal
