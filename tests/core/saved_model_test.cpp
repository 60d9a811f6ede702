// A saved model: going on with it is as if nothing had been between, and whatever else the bytes are, they are refused
// and nothing has changed.
#include "accrete/saved_model.h"

#include <gtest/gtest.h>

#include <cstring>

#include "accumulator/checksum.h"
#include "core/poster.h"

namespace accrete {
namespace {

using namespace test;

using Small = Accumulator<PosterLimits>;
using Bytes = std::vector<std::byte>;

constexpr int kFrames = 6;

struct Studio {
  Poster poster;
  std::unique_ptr<Small> a = fresh();

  Studio() { go_on(*a, 0, kFrames); }
  [[nodiscard]] std::unique_ptr<Small> fresh() const {
    auto made = std::make_unique<Small>();
    EXPECT_EQ(made->configure(poster.rig.rig), Status::kOk);
    return made;
  }
  void go_on(Small& accumulator, int from, int to) {
    for (int k = from; k < to; ++k)
      EXPECT_EQ(accumulator.step(poster.render(k), Poster::motion(k)).status, Status::kOk) << k;
  }
};

Bytes saved(const Small& a) {
  Bytes bytes(a.saved_bytes());
  EXPECT_EQ(a.save(bytes), Status::kOk);
  return bytes;
}

// As a hostile writer would: the checksum fits whatever is in front of it.
Bytes sealed(Bytes bytes) {
  const std::uint64_t crc = crc64(std::span(bytes).first(bytes.size() - 8));
  std::memcpy(bytes.data() + bytes.size() - 8, &crc, 8);
  return bytes;
}

TEST(Checksum, is_crc64_xz) {  // the check value that its definition states
  EXPECT_EQ(crc64(std::as_bytes(std::span("123456789", 9))), 0x995dc9bbdf1939faU);
}

TEST(SavedModel, goes_on_as_if_nothing_had_been_between) {
  Studio s;
  const Bytes bytes = saved(*s.a);
  SavedModelInfo info;
  ASSERT_EQ(read_saved_model_info(bytes, info), SavedModelFault::kNone);
  EXPECT_EQ(info.frames, static_cast<std::uint32_t>(kFrames));
  EXPECT_EQ(info.capacities, Small::kCapacities);
  EXPECT_EQ(info.width_px, static_cast<std::uint32_t>(s.poster.rig.rig.left.width_px));
  EXPECT_EQ(info.last, Poster::time_of(kFrames - 1));
  const auto b = s.fresh();
  s.go_on(*b, 0, 2);  // what it held is gone then
  ASSERT_EQ(b->restore(bytes).status, Status::kOk);
  EXPECT_TRUE(same(all_slots(s.a->model()), all_slots(b->model())));
  EXPECT_EQ(saved(*b), bytes);
  s.go_on(*s.a, kFrames, kFrames + 12);  // beyond the tenth: duplicates are merged there
  s.go_on(*b, kFrames, kFrames + 12);
  EXPECT_TRUE(same(all_slots(s.a->model()), all_slots(b->model())));
  EXPECT_EQ(saved(*s.a), saved(*b));
  EXPECT_GT(s.a->model().size(), 20U);
}

TEST(SavedModel, an_empty_one_is_a_model_too) {
  Studio s;
  const auto empty = s.fresh();
  ASSERT_EQ(s.a->restore(saved(*empty)).status, Status::kOk);
  EXPECT_EQ(s.a->model().size(), 0U);
  s.go_on(*s.a, 0, 2);
}

TEST(SavedModel, another_clock_may_begin_before_the_last_frame) {
  Studio s;
  const Bytes bytes = saved(*s.a);
  const auto b = s.fresh();
  ASSERT_EQ(b->restore(bytes).status, Status::kOk);
  EXPECT_EQ(b->step(s.poster.render(0), Poster::motion(0)).status, Status::kInvalidArgument);
  ASSERT_EQ(b->restore(bytes, RestoredClock::kStartsAnew).status, Status::kOk);
  const StepReport r = b->step(s.poster.render(0), Poster::motion(0));
  EXPECT_EQ(r.status, Status::kOk);
  EXPECT_GT(r.matched_stereo, 20U);  // the model is known again
}

TEST(SavedModel, needs_room_and_a_rig) {
  Studio s;
  Bytes bytes(s.a->saved_bytes() - 1);
  EXPECT_EQ(s.a->save(bytes), Status::kCapacityExceeded);
  const auto bare = std::make_unique<Small>();
  EXPECT_EQ(bare->save(bytes), Status::kUnavailable);
  EXPECT_EQ(bare->restore(saved(*s.a)).status, Status::kUnavailable);
}

struct OtherLimits : PosterLimits {
  static constexpr std::size_t kMaxPrimitives3d = PosterLimits::kMaxPrimitives3d + 16;
};

TEST(SavedModel, other_limits_are_refused_with_a_sentence) {
  Studio s;
  const auto other = std::make_unique<Accumulator<OtherLimits>>();
  ASSERT_EQ(other->configure(s.poster.rig.rig), Status::kOk);
  const RestoreReport r = other->restore(saved(*s.a));
  EXPECT_EQ(r.status, Status::kCapacityExceeded);
  EXPECT_EQ(r.fault, SavedModelFault::kOtherLimits);
  for (int i = 0; i <= static_cast<int>(SavedModelFault::kImpossible); ++i)
    EXPECT_GT(std::strlen(to_string(static_cast<SavedModelFault>(i))), 15U);
}

TEST(SavedModel, what_is_cut_off_or_damaged_is_refused_and_nothing_changes) {
  Studio s;
  const Bytes bytes = saved(*s.a);
  const auto b = s.fresh();
  s.go_on(*b, 0, 3);
  const Bytes before = saved(*b);
  const auto refused = [&](const Bytes& bad) {
    const RestoreReport r = b->restore(bad);
    EXPECT_NE(r.status, Status::kOk);
    return r.fault;
  };
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{7}, std::size_t{8}, std::size_t{60}, bytes.size() / 2, bytes.size() - 1})
    EXPECT_EQ(refused(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length))),
              length < 8 ? SavedModelFault::kNoModel : SavedModelFault::kCutOff)
        << length;
  Bytes longer = bytes;
  longer.push_back({});
  EXPECT_EQ(refused(longer), SavedModelFault::kCutOff);
  for (std::size_t at = 0; at < bytes.size(); at += at < 200 ? 1 : 4099) {
    Bytes bad = bytes;
    bad[at] ^= std::byte{0x10};
    EXPECT_NE(refused(bad), SavedModelFault::kNone) << at;
  }
  Bytes version = bytes, layout = bytes;
  version[8] ^= std::byte{2};
  layout[16] ^= std::byte{1};
  EXPECT_EQ(refused(sealed(version)), SavedModelFault::kOtherVersion);
  EXPECT_EQ(refused(sealed(layout)), SavedModelFault::kOtherLayout);
  EXPECT_EQ(saved(*b), before);
  s.go_on(*b, 3, 5);
}

// The checksum does not protect from somebody who knows it: what is taken up must be a state that the filter can bear.
TEST(SavedModel, a_sealed_lie_is_refused_or_harmless) {
  Studio s;
  const Bytes bytes = saved(*s.a);
  const auto b = s.fresh();
  Dice dice(11);
  int refused = 0, taken = 0;
  for (int i = 0; i < 160; ++i) {
    Bytes lie = bytes;
    for (int n = 0; n < 1 + i % 3; ++n) {
      const auto at = static_cast<std::size_t>(dice.uniform(60, static_cast<double>(bytes.size() - 8)));
      const auto width = i % 2 == 0 ? 1U : 4U;
      for (std::size_t k = at / width * width, end = k + width; k < end && k < bytes.size() - 8; ++k)
        lie[k] = width == 4 ? std::byte{0xff} : static_cast<std::byte>(dice.uniform(0, 255.9));
    }
    const RestoreReport r = b->restore(sealed(lie));
    if (r.status != Status::kOk) {
      ++refused;
      continue;
    }
    ++taken;
    if (taken % 8 != 0) continue;  // a step costs more than all the rest
    EXPECT_EQ(b->restore(sealed(lie), RestoredClock::kStartsAnew).status, Status::kOk);
    EXPECT_EQ(b->step(s.poster.render(kFrames), Poster::motion(kFrames)).status, Status::kOk);
    for (const Primitive3d& p : all_slots(b->model()))
      for (const float v : p.geometry.covariance) EXPECT_TRUE(std::isfinite(v));
  }
  EXPECT_GT(refused, 40);
  EXPECT_GT(taken, 8);
}

}  // namespace
}  // namespace accrete
