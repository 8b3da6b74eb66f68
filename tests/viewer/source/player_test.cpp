// The producing thread, with fast, slow and failing displays.

#include "viewer/source/player.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>
#include <vector>

#include "pillarfield/error.h"

namespace pillarfield::viewer {
namespace {

using std::chrono::milliseconds;

/// Observations of the producer, which the player owns.
struct Seen {
  std::mutex mutex;
  std::vector<std::uint64_t> frames;
  std::atomic<int> alive = 0;
  std::atomic<int> most_alive = 0;
  std::atomic<std::uint64_t> length = 10;
  std::atomic<std::uint64_t> fails_at = ~std::uint64_t{0};

  std::vector<std::uint64_t> produced() {
    const std::scoped_lock lock(mutex);
    return frames;
  }
};

/// Fields with nothing but an index.
class FakeProducer final : public FieldProducer {
 public:
  FakeProducer(std::shared_ptr<Seen> seen, double rate_hz) : seen_(std::move(seen)) {
    info_.name = "fake";
    info_.frames = seen_->length;
    info_.rate_hz = rate_hz;
  }
  [[nodiscard]] const SourceInfo& info() const override { return info_; }

  [[nodiscard]] ShownField produce(std::uint64_t index) override {
    if (index == seen_->fails_at) throw Error("fake", "cannot read this frame");
    {
      const std::scoped_lock lock(seen_->mutex);
      seen_->frames.push_back(index);
    }
    const int alive = ++seen_->alive;
    if (alive > seen_->most_alive) seen_->most_alive = alive;
    ShownField field;
    field.index = index;
    field.keep_alive = std::shared_ptr<const void>(new int(0), [seen = seen_](const int* memory) {
      delete memory;
      --seen->alive;
    });
    return field;
  }

  bool refresh() override {
    const std::uint64_t before = info_.frames;
    info_.frames = seen_->length;
    return info_.frames != before;
  }

 private:
  std::shared_ptr<Seen> seen_;
  SourceInfo info_;
};

struct Fixture {
  explicit Fixture(double rate_hz = 1e5, std::uint64_t frames = 10)
      : seen(std::make_shared<Seen>()) {
    seen->length = frames;
    player = play_file(std::make_unique<FakeProducer>(seen, rate_hz));
  }

  /// Waits until the thread fulfils a condition.
  template <class Condition>
  void wait_until(Condition condition) {
    while (!condition()) std::this_thread::sleep_for(milliseconds(1));
  }

  ShownField next_field() {
    std::optional<ShownField> field;
    wait_until([&] { return (field = player->take()).has_value(); });
    return *field;
  }

  std::shared_ptr<Seen> seen;
  std::unique_ptr<Player> player;
};

void expect_balanced(const PlayerStatistics& statistics) {
  EXPECT_EQ(statistics.produced, statistics.taken + statistics.not_shown + statistics.waiting);
  EXPECT_LE(statistics.waiting, 1U);
}

TEST(Player, ShowsTheFirstFrameAndWaits) {
  Fixture fixture;
  EXPECT_EQ(fixture.next_field().index, 0U);
  EXPECT_FALSE(fixture.player->state().playing);
  EXPECT_EQ(fixture.player->take(), std::nullopt);
  EXPECT_EQ(fixture.player->statistics().produced, 1U);
  EXPECT_EQ(fixture.player->info().name, "fake");
}

TEST(Player, NeverWaitsForASlowDisplayAndCountsWhatItDoesNotShow) {
  Fixture fixture;
  fixture.player->play();
  std::uint64_t taken = 0;
  while (fixture.player->statistics().produced < 2000) {
    expect_balanced(fixture.player->statistics());
    if (fixture.player->take()) ++taken;
    std::this_thread::sleep_for(milliseconds(3));
  }
  fixture.player->pause();
  const PlayerStatistics statistics = fixture.player->statistics();
  expect_balanced(statistics);
  EXPECT_EQ(statistics.taken, taken);
  EXPECT_GT(statistics.not_shown, 0U);
  EXPECT_LE(fixture.seen->most_alive, 3) << "one waits, one is made, one is being let go";
}

TEST(Player, FieldsOutliveIt) {
  Fixture fixture;
  const ShownField field = fixture.next_field();
  fixture.player->step(1);
  fixture.wait_until([&] { return fixture.player->statistics().waiting == 1; });
  fixture.player.reset();
  EXPECT_EQ(fixture.seen->alive, 1) << "the one taken, and not the one that waited";
}

TEST(Player, AnErrorComesOnceAfterTheFieldsBeforeIt) {
  Fixture fixture;
  fixture.seen->fails_at = 2;
  fixture.player->seek(1);
  fixture.wait_until([&] { return fixture.player->statistics().waiting == 1; });
  fixture.player->seek(2);
  bool thrown = false;
  fixture.wait_until([&] {
    try {
      static_cast<void>(fixture.player->take());
    } catch (const Error& error) {
      EXPECT_STREQ(error.what(), "fake: cannot read this frame");
      thrown = true;
    }
    return thrown;
  });
  fixture.player->seek(3);  // The thread has ended; no effect.
  EXPECT_EQ(fixture.player->take(), std::nullopt);
  expect_balanced(fixture.player->statistics());
}

TEST(Player, WakesTheDisplayForEveryFieldAndAnError) {
  Fixture fixture;
  static_cast<void>(fixture.next_field());
  std::atomic<int> woken = 0;
  fixture.player->on_new_field([&] { ++woken; });
  for (int i = 1; i <= 20; ++i) {
    fixture.player->step(1);
    fixture.wait_until([&] { return woken == i; });
    EXPECT_TRUE(fixture.player->take()) << "the wake came before the field";
  }
  fixture.player->on_new_field({});
  fixture.player->step(1);
  static_cast<void>(fixture.next_field());
  EXPECT_EQ(woken, 20);
  std::atomic<bool> failed = false;
  fixture.player->on_new_field([&] { failed = true; });
  fixture.seen->fails_at = 5;
  fixture.player->seek(5);
  fixture.wait_until([&] { return failed.load(); });
  EXPECT_THROW(static_cast<void>(fixture.player->take()), Error);
}

TEST(Player, FollowsASourceThatGrows) {
  Fixture fixture;
  static_cast<void>(fixture.next_field());
  fixture.player->set_follow(true);
  EXPECT_EQ(fixture.next_field().index, 9U);
  for (const std::uint64_t frames : {12U, 13U}) {
    fixture.seen->length = frames;
    EXPECT_EQ(fixture.next_field().index, frames - 1);
    EXPECT_EQ(fixture.player->state().frames, frames);
  }
}

TEST(Player, MayBeCalledFromManyThreads) {
  Fixture fixture(1e4, 50);
  std::atomic<bool> stop = false;
  std::vector<std::jthread> threads;
  threads.emplace_back([&] {
    while (!stop) expect_balanced(fixture.player->statistics());
  });
  threads.emplace_back([&] {
    while (!stop) static_cast<void>(fixture.player->take());
  });
  threads.emplace_back([&] {
    for (int i = 0; !stop; ++i) {
      fixture.player->play();
      fixture.player->set_speed(1 + i % 5);
      fixture.player->seek(static_cast<std::uint64_t>(i % 50));
      fixture.player->set_follow(i % 7 == 0);
      fixture.player->on_new_field([] {});
      static_cast<void>(fixture.player->state());
    }
  });
  std::this_thread::sleep_for(milliseconds(300));
  stop = true;
  threads.clear();
  fixture.player.reset();
  EXPECT_EQ(fixture.seen->alive, 0);
}

}  // namespace
}  // namespace pillarfield::viewer
