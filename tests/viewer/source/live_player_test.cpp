// A sensor on display: every frame is solved, whatever the display does.
#include "viewer/source/live_player.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

namespace pillarfield::viewer {
namespace {

constexpr std::uint32_t kSide = 16;  ///< sensels

Skin live_skin() {
  Skin skin;
  skin.rows = skin.cols = kSide;
  skin.counts_per_newton = 100;
  skin.threshold_counts = 2;
  return skin;
}

/// Bytes that a test makes its sensor send.
struct Wire {
  std::mutex mutex;
  std::condition_variable came;
  std::deque<std::vector<std::uint8_t>> frames;
  std::uint64_t sent = 0;
  std::uint64_t partial = 0;  ///< the next frames lack the upper left block
  double jump_s = 0;          ///< of the sensor's clock
  bool ended = false;

  void send(std::uint8_t reading) {
    std::vector<std::uint8_t> frame(std::size_t{kSide} * kSide, 0);
    for (std::size_t row = 4; row < 8; ++row) {
      for (std::size_t col = 4; col < 8; ++col) frame[row * kSide + col] = reading;
    }
    const std::scoped_lock lock(mutex);
    frames.push_back(std::move(frame));
    came.notify_one();
  }
  void end() {
    const std::scoped_lock lock(mutex);
    ended = true;
    came.notify_one();
  }
};

class FakeSensor final : public FrameStream {
 public:
  explicit FakeSensor(std::shared_ptr<Wire> wire) : wire_(std::move(wire)) {}
  [[nodiscard]] const Skin& skin() const override { return skin_; }
  [[nodiscard]] SenselType sensel_type() const override { return SenselType::u8; }
  [[nodiscard]] StreamHealth health() const override { return {.frames = sent_, .lost = 3}; }
  [[nodiscard]] Arrival next(StreamedFrame& frame, std::chrono::nanoseconds timeout) override {
    std::unique_lock lock(wire_->mutex);
    wire_->came.wait_for(lock, timeout, [&] { return !wire_->frames.empty() || wire_->ended; });
    if (wire_->frames.empty()) return wire_->ended ? Arrival::ended : Arrival::timed_out;
    std::ranges::copy(wire_->frames.front(), frame.buffer.readings<std::uint8_t>().begin());
    wire_->frames.pop_front();
    frame.readings = frame.buffer.view();
    frame.missing.clear();
    if (wire_->partial > 0) {
      frame.missing.push_back({0, 8, 0, 8});
      --wire_->partial;
    }
    frame.time_s = 0.001 * static_cast<double>(sent_) + wire_->jump_s;
    frame.sequence = sent_++;
    frame.arrived = std::chrono::steady_clock::now().time_since_epoch();
    return Arrival::arrived;
  }

 private:
  Skin skin_ = live_skin();
  std::shared_ptr<Wire> wire_;
  std::uint64_t sent_ = 0;
};

struct LiveFixture {
  template <class Condition>
  static void wait_until(Condition condition) {
    bool holds = condition();
    for (int i = 0; i < 300'000 && !holds; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      holds = condition();
    }
    ASSERT_TRUE(holds);
  }
  void send(std::uint8_t reading, int count = 1) {
    sent += static_cast<std::uint64_t>(count);
    for (int i = 0; i < count; ++i) wire->send(reading);
    wait_until([&] { return status().health.solved == sent; });
  }
  ShownField newest() const {
    std::optional<ShownField> newest;
    wait_until([&] { return (newest = player->take()).has_value(); });
    return *newest;
  }

  [[nodiscard]] LiveStatus status() const { return player->live()->status(); }

  std::shared_ptr<Wire> wire = std::make_shared<Wire>();
  OpenedSensor opened = play_sensor(std::make_unique<FakeSensor>(wire), "fake", {});
  Player* player = opened.player.get();
  Curves* curves = opened.curves.get();
  std::uint64_t sent = 0;
};

TEST(LivePlayer, SolvesEveryFrameAndShowsTheNewest) {
  LiveFixture live;
  live.send(50, 100);
  live.send(100);
  const ShownField field = live.newest();
  EXPECT_EQ(field.forces.normal[2 * 8 + 2], 1);
  EXPECT_EQ(static_cast<const std::uint8_t*>(field.raw.data)[4 * kSide + 4], 100);
  EXPECT_TRUE(field.arrived);
  const PlayerStatistics statistics = live.player->statistics();
  EXPECT_EQ(statistics.produced, 101U);
  EXPECT_EQ(statistics.taken + statistics.not_shown + statistics.waiting, 101U);
  const auto points = live.curves->between(-1, 1e9, 1000);
  ASSERT_EQ(points.size(), 101U);
  EXPECT_FLOAT_EQ(points.front().normal, 2);
  EXPECT_FLOAT_EQ(points.back().normal, 4);
  EXPECT_EQ(live.status().health.stream.lost, 3U);
  EXPECT_EQ(live.player->state().frames, 0U);
}

TEST(LivePlayer, PauseFreezesThePictureNotTheSensor) {
  LiveFixture live;
  live.send(50);
  static_cast<void>(live.newest());
  live.player->pause();
  live.send(80, 5);
  EXPECT_FALSE(live.player->take());
  EXPECT_EQ(live.curves->between(-1, 1e9, 1000).size(), 6U);
  live.player->play();
  live.send(100);
  EXPECT_EQ(live.newest().forces.normal[2 * 8 + 2], 1);
}

TEST(LivePlayer, ContactsComeWhenAskedFor) {
  LiveFixture live;
  live.send(100);
  EXPECT_EQ(live.newest().contacts, nullptr);
  live.player->set_contacts(true);
  live.send(100, 2);
  ShownField field;
  LiveFixture::wait_until([&] {
    live.send(50);
    field = live.newest();
    return field.contacts != nullptr;
  });
  ASSERT_EQ(field.contacts->found.contacts.size(), 1U);
  EXPECT_FLOAT_EQ(static_cast<float>(field.contacts->found.total.normal_n), 2);
  EXPECT_EQ(field.forces.normal[2 * 8 + 2], 0.5F);
}

TEST(LivePlayer, TellsATareThatIsRefusedFromOneThatIsInsistedOn) {
  LiveFixture live;
  const auto tare = [&](std::uint64_t message) {
    live.player->live()->tare();
    LiveFixture::wait_until([&] {
      live.send(200);
      return live.status().messages == message;
    });
    return live.status();
  };
  live.send(200);
  EXPECT_TRUE(tare(1).failed);
  EXPECT_EQ(live.status().tares, 0U);
  EXPECT_FALSE(tare(2).failed);
  EXPECT_EQ(live.status().tares, 1U);
}

TEST(LivePlayer, ASensorMayStopAndEnd) {
  LiveFixture live;
  live.send(100);
  std::this_thread::sleep_for(std::chrono::milliseconds(120));
  EXPECT_GT(live.status().health.since_frame_s, 0.1);
  const auto before = std::chrono::steady_clock::now();
  live.send(100);
  const double silent_s = live.status().health.since_frame_s;
  const std::chrono::duration<double> since = std::chrono::steady_clock::now() - before;
  EXPECT_LE(silent_s, since.count());
  EXPECT_FALSE(live.status().ended);
  live.wire->end();
  LiveFixture::wait_until([&] { return live.status().ended; });
  EXPECT_EQ(live.newest().forces.normal[2 * 8 + 2], 1);
}

TEST(FieldClock, IsTheSensorsWhileThatRuns) {
  FieldClock clock;
  const auto arrived = std::chrono::steady_clock::now().time_since_epoch();
  double last_s = clock.time_s(50, arrived);
  for (const double sensor_s : {50.001, 50.003, 1050.0, -3.0}) {
    const double time_s = clock.time_s(sensor_s, arrived + std::chrono::milliseconds(7));
    if (sensor_s < 51 && sensor_s > 0) {
      EXPECT_NEAR(time_s - last_s, sensor_s - (sensor_s > 50.002 ? 50.001 : 50), 1e-9);
    } else {
      EXPECT_GT(time_s, last_s);
      EXPECT_LT(time_s, last_s + 1) << "a clock that jumps";
    }
    last_s = time_s;
  }
}

}  // namespace
}  // namespace pillarfield::viewer
