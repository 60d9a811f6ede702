// A step that is lent a thread does the same as one that is not, every time, and nothing is left running.
#include <gtest/gtest.h>
#include <pthread.h>

#include <array>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <thread>

#include "accrete/accumulator.h"
#include "accrete/hal/second_thread.h"
#include "core/poster.h"

namespace accrete::hal {
namespace {

using test::Poster;
using Small = Accumulator<test::PosterLimits>;

struct Called {
  std::array<int, 2> times{};
  std::array<std::thread::id, 2> by;
};
void note(void* argument, int which) {
  auto& called = *static_cast<Called*>(argument);
  const auto i = static_cast<std::size_t>(which);
  ++called.times.at(i);
  called.by.at(i) = std::this_thread::get_id();
}

TEST(SecondThread, calls_both_once_in_two_threads_and_returns_after_both) {
  SecondThread second;
  ASSERT_TRUE(second.available());
  const PairRunner runner = second.runner();
  for (int i = 0; i < 20000; ++i) {
    Called called;
    runner.run(runner.context, note, &called);
    ASSERT_EQ(called.times, (std::array{1, 1})) << i;
    ASSERT_EQ(called.by[0], std::this_thread::get_id());
    ASSERT_NE(called.by[1], std::this_thread::get_id());
  }
}

TEST(SecondThread, ends_whether_it_was_used_or_not) {
  for (int i = 0; i < 500; ++i) {
    SecondThread second;
    if (i % 2 == 0) continue;
    Called called;
    second.runner().run(second.runner().context, note, &called);
  }
}

TEST(SecondThread, throws_what_a_task_threw_when_both_are_done_and_goes_on) {
  SecondThread second;
  for (const int bad : {0, 1, 0, 1}) {
    struct {
      int bad;
      std::array<bool, 2> called;
    } work{bad, {}};
    const auto task = [](void* argument, int which) {
      auto& w = *static_cast<decltype(work)*>(argument);
      w.called.at(static_cast<std::size_t>(which)) = true;
      if (which == w.bad) throw std::runtime_error("as planned");
    };
    EXPECT_THROW(second.run_both(task, &work), std::runtime_error);
    EXPECT_TRUE(work.called[0] && work.called[1]);
  }
  Called called;
  second.run_both(note, &called);
  EXPECT_EQ(called.times, (std::array{1, 1}));
}

// No thread starts while this is there: none has room for its stack.
class NoRoom {
 public:
  NoRoom() {
    pthread_getattr_default_np(&before_);
    pthread_attr_t huge;
    pthread_getattr_default_np(&huge);
    pthread_attr_setstacksize(&huge, SIZE_MAX / 4 / 65536 * 65536);
    pthread_setattr_default_np(&huge);
    pthread_attr_destroy(&huge);
  }
  NoRoom(const NoRoom&) = delete;
  NoRoom& operator=(const NoRoom&) = delete;
  ~NoRoom() {
    pthread_setattr_default_np(&before_);
    pthread_attr_destroy(&before_);
  }

 private:
  pthread_attr_t before_{};
};

TEST(SecondThread, where_the_system_has_none_both_are_called_by_the_caller) {
  const NoRoom no_room;
  SecondThread none;
  EXPECT_FALSE(none.available());
  EXPECT_EQ(none.runner().run, nullptr);
  Called called;
  none.run_both(note, &called);
  EXPECT_EQ(called.times, (std::array{1, 1}));
  EXPECT_EQ(called.by[1], std::this_thread::get_id());
}

std::unique_ptr<Small> configured(const Poster& poster) {
  auto a = std::make_unique<Small>();
  EXPECT_EQ(a->configure(poster.rig.rig), Status::kOk);
  return a;
}
std::vector<std::byte> bits(const Small& a) {
  std::vector<std::byte> out(a.saved_bytes());
  EXPECT_EQ(a.save(out), Status::kOk);
  return out;
}

// The right image first, in this thread.
void run_backwards(void* /*context*/, void (*task)(void* argument, int which), void* argument) {
  task(argument, 1);
  task(argument, 0);
}

TEST(SecondThread, a_step_has_the_same_bits_whoever_runs_it) {
  SecondThread second;
  Poster poster;
  const auto alone = configured(poster), shared = configured(poster), backwards = configured(poster);
  shared->set_pair_runner(second.runner());
  backwards->set_pair_runner({&run_backwards, nullptr});
  for (int k = 0; k < 12; ++k) {
    const StereoFrame frame = poster.render(k);
    const StepReport r = alone->step(frame, Poster::motion(k));
    ASSERT_EQ(r.status, Status::kOk);
    for (Small* other : {shared.get(), backwards.get()}) {
      const StepReport s = other->step(frame, Poster::motion(k));
      EXPECT_EQ(s.left.primitives, r.left.primitives);
      EXPECT_EQ(s.right.primitives, r.right.primitives);
      EXPECT_EQ(s.left.refused_dimension, r.left.refused_dimension);
      EXPECT_EQ(s.right.refused_dimension, r.right.refused_dimension);
      EXPECT_EQ(s.updated, r.updated);
    }
  }
  EXPECT_GT(alone->model().size(), 50U);
  EXPECT_EQ(bits(*alone), bits(*shared));
  EXPECT_EQ(bits(*alone), bits(*backwards));
  shared->set_pair_runner({});  // taken back
  EXPECT_EQ(shared->step(poster.render(12), Poster::motion(12)).status, Status::kOk);
}

}  // namespace
}  // namespace accrete::hal
