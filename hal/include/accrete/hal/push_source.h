// Everybody else's cameras: whoever has images hands them in, from any thread, and whoever accumulates takes them out.
// What happens when nobody takes them is one rule: the newest frames stay, the oldest are dropped and counted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "accrete/hal/stereo_source.h"

namespace accrete::hal {

struct PushSettings {
  StereoRig rig;             // image sizes of zero: any; otherwise images of another size are refused
  std::size_t capacity = 4;  // pairs that wait at most, 1 .. 1000; as many single images a side
  // Images that are pushed one by one are a pair when their times differ by at most this: below half a period.
  std::int64_t max_skew_ns = 8'000'000;
};

struct PushCounters {
  std::uint64_t pushed = 0;       // pairs: pushed as such, or joined of two images
  std::uint64_t delivered = 0;    // pairs that were taken out
  std::uint64_t overwritten = 0;  // pairs that had to give way to newer ones
  std::uint64_t unpaired = 0;     // single images without a partner
  std::uint64_t refused = 0;      // calls that did not return kOk
};

class PushQueue;

class PushSource final : public StereoSource {
 public:
  // Called exactly once, from any thread and with no lock held, when the pixels of a push are no longer needed; also
  // when the push is refused or dropped. Must not throw.
  using Release = std::function<void()>;

  explicit PushSource(const PushSettings& settings);  // looked at by configure()
  ~PushSource() override;

  // A pair, from any thread. Without `release` the pixels are copied before the call returns, into buffers that are
  // used again; with it they are borrowed until it is called. frame.sequence is ignored: pairs are numbered from 0 as
  // they come, and a gap in what acquire() lends is what was overwritten. kUnavailable: not streaming, or closed.
  // kInvalidArgument: an image that cannot be read or of another size than the rig's, or a left time not after that of
  // the pair before. Never waits for the other side.
  Status push(const StereoFrame& frame, Release release = {});

  // One image; the pair is complete when its partner is there. Images of one side must come in the order of time.
  // Images that are older than the last pair, or too many without a partner, are dropped and counted. Statuses as push.
  Status push_left(const ImageView& image, Timestamp t, Release release = {});
  Status push_right(const ImageView& image, Timestamp t, Release release = {});

  // No more will come: acquire() still lends what waits, then it is kEndOfStream. From any thread.
  void close();

  // From any thread; counters() of the base class are the same numbers as of the last acquire().
  [[nodiscard]] PushCounters pushed() const;

 private:
  Outcome do_configure() override;
  Outcome do_start() override;
  Outcome do_acquire(std::int64_t timeout_ns, StereoFrame& frame) override;
  void do_release() override;
  void do_stop() override;

  PushSettings settings_;
  std::unique_ptr<PushQueue> queue_;
};

}  // namespace accrete::hal
