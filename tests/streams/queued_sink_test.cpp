// Live sinks behind a queue: what is dropped is counted, and nothing waits for a slow sink.

#include "streams/sink/queued_sink.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "pillarfield/error.h"
#include "streams/message/topics.h"

namespace pillarfield {
namespace {

/// Actions of a consumer; the test controls when it goes on.
struct Log {
  std::mutex mutex;
  std::condition_variable changed;
  std::size_t allowed = 0;  // frames that it may still begin
  bool is_waiting = false;
  std::vector<std::uint64_t> sequences;
  std::vector<float> values;  // the first normal force
  std::uint64_t reports = 0;
  bool finished = false;
  FrameParts wanted = {.forces = true, .contacts = true, .readings = true};
  std::function<bool(const SolvedFrame&)> consume = [](const SolvedFrame&) { return true; };

  void allow(std::size_t frames) {
    const std::scoped_lock lock(mutex);
    allowed += frames;
    changed.notify_all();
  }
  void wait_until(const std::function<bool()>& condition) {
    std::unique_lock lock(mutex);
    ASSERT_TRUE(changed.wait_for(lock, std::chrono::minutes(5), condition));
  }
};

class LoggedConsumer final : public SinkConsumer {
 public:
  explicit LoggedConsumer(Log& log) : log_(log) {}

  [[nodiscard]] FrameParts wants(const SolvedFrame&) override { return log_.wanted; }
  [[nodiscard]] bool consume(const SolvedFrame& frame) override {
    std::unique_lock lock(log_.mutex);
    log_.is_waiting = true;
    log_.changed.notify_all();
    log_.changed.wait(lock, [&] { return log_.allowed > 0; });
    log_.is_waiting = false;
    --log_.allowed;
    log_.sequences.push_back(frame.sequence);
    if (!frame.forces.normal.empty()) log_.values.push_back(frame.forces.normal[0]);
    log_.changed.notify_all();
    return log_.consume(frame);
  }
  void report(const HealthReport&) override {
    const std::scoped_lock lock(log_.mutex);
    ++log_.reports;
    log_.changed.notify_all();
  }
  void finish() override { log_.finished = true; }

 private:
  Log& log_;
};

constexpr std::size_t kUnlimited = ~std::size_t{0};

class QueuedSinkTest : public ::testing::Test {
 protected:
  void open(const QueueLimits& limits) {
    sink_ = std::make_unique<QueuedSink>("test", std::make_unique<LoggedConsumer>(log_), limits);
  }
  /// Appends a frame whose memory does not outlive the call.
  void append(std::uint64_t sequence, std::uint32_t pillars = 4) {
    ForceField field(1, pillars);
    if (pillars > 0) field.normal[0] = static_cast<float>(sequence);
    SolvedFrame frame;
    frame.forces = field.view();
    frame.sequence = sequence;
    sink_->append(frame);
  }
  /// Appends a frame and waits until the consumer has begun it.
  void append_and_begin(std::uint64_t sequence) {
    append(sequence);
    log_.wait_until([&] { return log_.is_waiting; });
  }

  Log log_;
  std::unique_ptr<QueuedSink> sink_;
};

TEST_F(QueuedSinkTest, DropsWhatDoesNotFitAndCountsIt) {
  open({.frames = 3, .bytes = kUnlimited});
  append_and_begin(0);
  for (std::uint64_t sequence = 1; sequence < 10; ++sequence) append(sequence);
  log_.allow(3);
  log_.wait_until([&] { return log_.sequences.size() == 3; });
  log_.allow(100);
  sink_->finish();
  // The frame being consumed holds one of the three places.
  EXPECT_EQ(log_.sequences, (std::vector<std::uint64_t>{0, 1, 2}));
  EXPECT_EQ(log_.values, (std::vector<float>{0, 1, 2}));
  EXPECT_EQ(sink_->statistics().frames, 3u);
  EXPECT_EQ(sink_->statistics().dropped, 7u);
  EXPECT_TRUE(log_.finished);
}

TEST_F(QueuedSinkTest, LimitsBytes) {
  constexpr std::uint32_t kPillars = 100;
  constexpr std::size_t kBytes = std::size_t{13} * kPillars;  // three floats and a status byte each
  open({.frames = 100, .bytes = 3 * kBytes + 1});
  for (std::uint64_t sequence = 0; sequence < 5; ++sequence) append(sequence, kPillars);
  EXPECT_EQ(sink_->statistics().dropped, 2u);
  append(5, 0);
  log_.allow(100);
  sink_->finish();
  EXPECT_EQ(log_.sequences, (std::vector<std::uint64_t>{0, 1, 2, 5}));
  open({.frames = 100, .bytes = 1});
  append(6, 1000);  // One frame may always wait.
  sink_->finish();
  EXPECT_EQ(log_.sequences.back(), 6u);
}

TEST_F(QueuedSinkTest, KeepsTheOrderOfManyFrames) {
  open({.frames = 4, .bytes = kUnlimited});
  log_.allow(100'000);
  std::uint64_t next = 0;
  while (sink_->statistics().frames < 2000) append(next++);
  sink_->finish();
  const LiveSinkStatistics done = sink_->statistics();
  EXPECT_EQ(done.frames + done.dropped, next);
  EXPECT_EQ(done.frames, log_.sequences.size());
  EXPECT_TRUE(std::ranges::is_sorted(log_.sequences, std::less_equal()));
  for (std::size_t i = 0; i < log_.values.size(); ++i) {
    ASSERT_EQ(log_.values[i], static_cast<float>(log_.sequences[i]));
  }
}

TEST_F(QueuedSinkTest, StopsAtAFailure) {
  open({.frames = 10, .bytes = kUnlimited});
  log_.consume = [](const SolvedFrame& frame) {
    if (frame.sequence == 2) throw Error("there", "it broke", "mend it");
    return frame.sequence != 1;  // lost
  };
  append_and_begin(0);
  for (std::uint64_t sequence = 1; sequence < 6; ++sequence) append(sequence);
  log_.allow(100);
  log_.wait_until([&] { return log_.sequences.size() == 3; });
  while (sink_->statistics().failure.empty()) std::this_thread::yield();
  append(6);
  sink_->finish();
  const LiveSinkStatistics done = sink_->statistics();
  EXPECT_EQ(done.failure, "there: it broke; mend it");
  EXPECT_EQ(done.frames, 1u);
  EXPECT_EQ(done.dropped, 6u);
  EXPECT_FALSE(log_.finished);
}

TEST_F(QueuedSinkTest, DestroyedSinkConsumesWhatWaitsButDoesNotFinish) {
  open({.frames = 10, .bytes = kUnlimited});
  for (std::uint64_t sequence = 0; sequence < 5; ++sequence) append(sequence);
  log_.allow(5);
  sink_.reset();
  EXPECT_EQ(log_.sequences.size(), 5u);
  EXPECT_FALSE(log_.finished);
}

TEST_F(QueuedSinkTest, SkipsFramesThatAreNotWanted) {
  log_.wanted = {};
  open({});
  append(0);
  sink_->finish();
  append(1);
  EXPECT_TRUE(log_.sequences.empty());
  EXPECT_EQ(sink_->statistics().dropped, 0u);
}

TEST_F(QueuedSinkTest, PassesReportsOn) {
  open({});
  sink_->report({});
  log_.wait_until([&] { return log_.reports == 1; });
  sink_->finish();
  sink_->report({});
  EXPECT_EQ(log_.reports, 1u);
}

}  // namespace
}  // namespace pillarfield
