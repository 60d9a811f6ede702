// Slots, ids and generations; who goes when it is full; and how a model looks at it.
#include "store/store.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "accrete/contract.h"
#include "core/picture.h"
#include "core/storage.h"
#include "existence/evidence.h"

namespace accrete {
namespace {

using test::Dice;
using test::OwnedStore;

TEST(Store, ids_go_stale_and_are_never_given_twice) {
  OwnedStore store(16);
  std::set<std::pair<std::uint32_t, std::uint32_t>> given;
  std::vector<PrimitiveId> gone;
  Dice dice(1);
  std::vector<std::uint32_t> used;
  for (int k = 0; k < 500; ++k) {
    if (k == 250) {  // emptying does not begin anew
      for (const std::uint32_t s : used) gone.push_back(store.id(s));
      used.clear();
      store->clear();
    }
    if (store->free_count > 0 && (used.empty() || dice.chance(0.55))) {
      const std::uint32_t slot = store.add(0);
      const PrimitiveId id = store.id(slot);
      EXPECT_FALSE(id.is_null());
      EXPECT_TRUE(given.insert({id.index1, id.generation}).second);
      Primitive3d p;
      EXPECT_EQ(store.view().find(id, p), Status::kOk);
      EXPECT_EQ(p.id, id);
      used.push_back(slot);
    } else if (!used.empty()) {
      const std::size_t i = dice.below(used.size());
      gone.push_back(store.id(used[i]));
      store->release(used[i]);
      used.erase(used.begin() + static_cast<std::ptrdiff_t>(i));
    }
    EXPECT_EQ(store->size(), used.size());
    EXPECT_EQ(store->free_count, 16 - used.size());
  }
  Primitive3d p;
  for (const PrimitiveId id : gone) EXPECT_EQ(store.view().find(id, p), Status::kNotFound);
  EXPECT_EQ(store.view().find({}, p), Status::kNotFound);
  EXPECT_EQ(store.view().find({17, 1}, p), Status::kNotFound);
  EXPECT_EQ(store.view().find({0xFFFFFFFFU, 1}, p), Status::kNotFound);
}

TEST(Store, free_slots_are_used_in_turn) {
  OwnedStore store(16);
  for (int k = 0; k < 5; ++k) store.add(0);
  store->release(2);
  // One that was just freed comes last, so that no slot wears out its generations.
  for (std::uint32_t k = 5; k < 16; ++k) EXPECT_EQ(store.add(0), k);
  EXPECT_EQ(store.add(0), 2U);
  EXPECT_EQ(store->free_count, 0U);
}

TEST(Store, what_a_free_slot_holds_is_finite_and_positive_definite) {
  OwnedStore store(32);
  const std::uint32_t slot = store.add(0);
  for (auto& row : store->geometry[0].row) row[slot] = std::nanf("");
  for (auto& row : store->appearance[0].row) row[slot] = -1;
  store->release(slot);
  for (std::size_t lane = 0; lane < 32; ++lane) {
    const Geometry g = load(store->geometry[lane / 16], lane % 16);
    const AppearanceState a = load(store->appearance[lane / 16], lane % 16);
    EXPECT_EQ(g.quaternion[3], 1);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(g.covariance[packed_index(6, i, i)], 1);
    for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(a.covariance[packed_index(7, i, i)], 1);
  }
}

TEST(Store, evicts_the_least_likely_then_the_oldest_and_nobody_worth_keeping) {
  OwnedStore store(16);
  const float odds[16] = {3, -1, 0, 5, -1, 2, 0, 6, 1, -1, 4, 0, 2, 5, 1, 3};
  for (std::uint32_t k = 0; k < 16; ++k) store.add(odds[k], 100 - k);
  EXPECT_EQ(store->make_room(0, 4.6F), 0U);
  EXPECT_EQ(store->make_room(4, 4.6F), 4U);
  // The three of -1, and of those with 0 the one that is oldest: born in frame 100 - 11.
  std::set<std::uint32_t> gone;
  for (std::uint32_t k = 0; k < 16; ++k)
    if (store->tracks[k].state == State::kFree) gone.insert(k);
  EXPECT_EQ(gone, (std::set<std::uint32_t>{1, 4, 9, 11}));
  EXPECT_EQ(store->make_room(4, 4.6F), 0U);  // there is room
  EXPECT_EQ(store->make_room(16, 4.6F), 9U);
  for (const std::uint32_t k : {3U, 7U, 13U}) EXPECT_NE(store->tracks[k].state, State::kFree);
  EXPECT_EQ(store->size(), 3U);
  EXPECT_EQ(store->make_room(16, 4.6F), 0U);
}

TEST(Store, eviction_against_sorting_everything) {
  Dice dice(2);
  for (int round = 0; round < 50; ++round) {
    OwnedStore store(64);
    std::vector<std::array<float, 3>> all;
    for (std::uint32_t k = 0; k < 64; ++k) {
      const auto odds = static_cast<float>(dice.below(8));
      const auto born = static_cast<std::uint32_t>(dice.below(5));
      const std::uint32_t slot = store.add(odds, born);
      all.push_back({odds, static_cast<float>(born), static_cast<float>(slot)});
    }
    std::sort(all.begin(), all.end());
    const std::size_t wanted = dice.below(65);
    const auto evictable =
        static_cast<std::size_t>(std::count_if(all.begin(), all.end(), [](const auto& a) { return a[0] < 5; }));
    const std::uint32_t n = store->make_room(wanted, 5);
    EXPECT_EQ(n, std::min(wanted, evictable));
    for (std::size_t i = 0; i < 64; ++i)
      EXPECT_EQ(store->tracks[static_cast<std::size_t>(all[i][2])].state == State::kFree, i < n);
  }
}

int violations = 0;
TEST(Store, misuse_is_told_to_the_contract_handler) {
  const ContractHandler before = set_contract_handler([](const ContractViolation&) { ++violations; });
  OwnedStore store(16);
  const std::uint32_t slot = store.add(0);
  store->release(slot);
  EXPECT_EQ(violations, 0);
  store->release(slot);  // twice
  EXPECT_EQ(violations, 1);
  set_contract_handler(before);
}

TEST(ModelView, shows_a_primitive_with_its_tangent_bias_and_misfit) {
  OwnedStore store(16);
  const std::uint32_t slot = store.add(existence::log_odds(0.9F), 3, State::kConfirmed);
  Dice dice(4);
  Geometry g;
  g.position = {0.1F, 0.2F, 0.3F};
  const Quaternion q = normalized({0.3, -0.5, 0.2, 0.8}).value();
  g.quaternion = {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z), static_cast<float>(q.w)};
  for (std::size_t i = 0; i < 6; ++i) g.covariance[packed_index(6, i, i)] = 1e-6F * static_cast<float>(i + 1);
  g.covariance[packed_index(6, 0, 4)] = 5e-7F;
  accrete::store(g, store->geometry[0], slot);
  store->tracks[slot].pitch_m = 0.006F;
  store->tracks[slot].observations = 7;
  store->tracks[slot].last_frame = 9;

  const Mat3 R = to_matrix(q);
  const Primitive3d p = store.view(0.1F).at(slot);
  EXPECT_EQ(p.state, State::kConfirmed);
  EXPECT_NEAR(p.existence, 0.9, 1e-5);
  EXPECT_EQ(p.observations, 7U);
  EXPECT_EQ(p.first_frame, 3U);
  EXPECT_EQ(p.last_frame, 9U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(p.tangent[i], R[3 * i], 1e-6);
  // The bias lies across the tangent and nowhere else: 0.1 of a pitch on local y and z. Inside, position errors are in
  // the own frame; what leaves the model has them in the map.
  const double own[6] = {1e-6, 2e-6 + 0.0006 * 0.0006, 3e-6 + 0.0006 * 0.0006, 4e-6, 5e-6, 6e-6};
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = i; j < 6; ++j) {
      double expected = i == j && i >= 3 ? own[i] : 0;
      for (std::size_t k = 0; k < 3 && j < 3; ++k) expected += own[k] * R[3 * i + k] * R[3 * j + k];
      if (i < 3 && j == 4) expected = 5e-7 * R[3 * i];  // of what is along and the tilt
      EXPECT_NEAR(p.geometry.covariance[packed_index(6, i, j)], expected, 1e-11);
    }
  // One that fits worse than the others is less certain than it says; one that fits better is not more certain.
  store->tracks[slot].misfit = 3;
  const auto roll = [&](float typical) {
    return store.view(0, typical).at(slot).geometry.covariance[packed_index(6, 3, 3)];
  };
  EXPECT_NEAR(roll(1), 1.2e-5, 1e-11);
  EXPECT_NEAR(roll(3), 4e-6, 1e-11);
  EXPECT_NEAR(roll(10), 4e-6, 1e-11);
}

TEST(ModelView, counts_what_is_confirmed_or_preserved) {
  OwnedStore store(32);
  store.add(0);
  store.add(5, 0, State::kConfirmed);
  store.add(5, 0, State::kPreserved);
  store->release(store.add(5, 0, State::kConfirmed));
  EXPECT_EQ(store.view().size(), 2U);
  EXPECT_EQ(store.view().slots(), 32U);
  EXPECT_EQ(store.view().state(0), State::kTentative);
  EXPECT_EQ(store.view().state(3), State::kFree);
  EXPECT_EQ(ModelView().size(), 0U);
}

}  // namespace
}  // namespace accrete
