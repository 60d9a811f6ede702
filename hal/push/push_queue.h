// The queue of a push source: pairs and single images that wait, and the buffers of their pixels.
#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

#include "accrete/hal/push_source.h"

namespace accrete::hal {

// One image of a push. Borrowed pixels are released with it.
struct PushedImage {
  ImageView view;
  Timestamp t;
  std::vector<std::uint8_t> copy;        // holds the pixels unless they are borrowed
  std::shared_ptr<const void> borrowed;  // its end calls the release; shared by the two images of a pair
};

struct PushedPair {
  PushedImage left, right;
  std::uint64_t sequence = 0;
};

class PushQueue {
 public:
  explicit PushQueue(const PushSettings& settings) : settings_(settings) {}

  void open();   // empty, numbering from 0
  void close();  // what waits may still be taken
  void stop();   // drops what waits; nothing more is taken in

  Status push(const StereoFrame& frame, std::shared_ptr<const void> borrowed);
  enum class Side { kLeft, kRight };
  Status push(Side side, const ImageView& image, Timestamp t, std::shared_ptr<const void> borrowed);

  // Lends the next pair, waits for it. kTimeout, kEndOfStream.
  Status take(std::int64_t timeout_ns, StereoFrame& frame);
  void give_back();

  [[nodiscard]] PushCounters counters() const;

 private:
  // What leaves the queue goes here, and ends outside the lock: releases are the caller's code.
  using Waste = std::vector<PushedImage>;

  [[nodiscard]] bool fits(const ImageView& image, const Camera& camera) const;
  Status refuse(Status status);
  // A copy in a buffer that is used again, or the view itself where it is borrowed. Takes the lock for the buffer
  // alone.
  PushedImage keep(const ImageView& image, Timestamp t, const std::shared_ptr<const void>& borrowed);
  // Under the lock:
  void discard(PushedImage&& image, Waste& waste);
  void insert(PushedImage&& left, PushedImage&& right, Waste& waste);
  void drop_older(std::deque<PushedImage>& side, Timestamp t, Waste& waste);

  PushSettings settings_;
  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  bool streaming_ = false, closed_ = false;
  std::deque<PushedPair> pairs_;
  std::deque<PushedImage> left_, right_;  // without a partner so far
  std::optional<PushedPair> lent_;
  std::vector<std::vector<std::uint8_t>> buffers_;  // free ones
  std::uint64_t next_sequence_ = 0;
  std::optional<Timestamp> last_left_;  // of the last pair
  PushCounters counters_;
};

}  // namespace accrete::hal
