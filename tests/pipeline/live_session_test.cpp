// The rules of a live run: tare, pause, recording, events.

#include "pillarfield/live_session.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "pillarfield/calibration.h"
#include "pillarfield/error.h"
#include "pillarfield/pipeline.h"
#include "pillarfield/recording.h"

namespace pillarfield {
namespace {

using std::chrono::milliseconds;

SolverPlan plan_of_live_skin() {
  SolverPlan plan;
  plan.skin.rows = plan.skin.cols = 16;
  plan.calibration.tare.assign(plan.skin.sensels(), 0);
  return plan;
}

/// An untouched sensor whose frames come every millisecond of its own time, as fast as they are
/// read.
class IdleSensor final : public FrameStream {
 public:
  [[nodiscard]] const Skin& skin() const override { return plan_.skin; }
  [[nodiscard]] SenselType sensel_type() const override { return SenselType::u8; }
  [[nodiscard]] Arrival next(StreamedFrame& frame, std::chrono::nanoseconds) override {
    std::ranges::fill(frame.buffer.readings<std::uint8_t>(), reading);
    frame.readings = frame.buffer.view();
    frame.missing.clear();
    frame.sequence = sent++;
    frame.arrived = milliseconds(frame.sequence);
    frame.time_s = 1e-3 * static_cast<double>(frame.sequence);
    return Arrival::arrived;
  }

  std::uint8_t reading = 20;
  std::uint64_t sent = 0;

 private:
  SolverPlan plan_ = plan_of_live_skin();
};

class LiveSessionTest : public testing::Test {
 public:
  ~LiveSessionTest() override { std::filesystem::remove(path_); }

 protected:
  /// Runs for this many more frames, and returns the events.
  std::vector<LiveEvent> run(std::uint64_t frames) {
    const std::uint64_t end = sensor_.sent + frames;
    session_.run({.stop = [this, end] { return sensor_.sent >= end; }});
    return session_.take_events();
  }
  /// Ends the recording and returns its tare.
  std::vector<float> recorded_tare() {
    EXPECT_TRUE(session_.stop_recording(7));
    std::vector<LiveEvent> events;
    while ((events = session_.take_events()).empty()) std::this_thread::sleep_for(milliseconds(1));
    EXPECT_EQ(events.size(), 1U);
    EXPECT_EQ(events[0].kind, LiveEvent::Kind::recording);
    EXPECT_EQ(events[0].tag, 7U);
    EXPECT_EQ(events[0].error, "");
    EXPECT_EQ(events[0].recording, path_);
    const auto recorded = open_frames(path_);
    EXPECT_EQ(recorded->frames(), events[0].recorded.frames);
    return recorded->calibration().tare;
  }

  const std::string path_ =
      std::filesystem::temp_directory_path() / ("live_session_" + std::to_string(getpid()) + ".h5");
  IdleSensor sensor_;
  SolverPlan plan_ = plan_of_live_skin();
  Processor processor_{open_device(), plan_};
  LiveSession session_{sensor_, plan_, processor_, live_sink_info(plan_, "", "idle")};
};

std::vector<float> plane_of(float counts) {
  std::vector<float> plane(std::size_t{16} * 16, counts);
  return plane;
}

TEST_F(LiveSessionTest, ARecordingWithoutTareGetsTheFirstOneThatIsMeasured) {
  session_.record(path_);
  EXPECT_EQ(session_.recording(), path_);
  EXPECT_TRUE(run(5).empty());
  ASSERT_TRUE(session_.start_tare(milliseconds(100), false, 3));
  EXPECT_FALSE(session_.start_tare(milliseconds(100)));
  EXPECT_TRUE(session_.is_taring());
  std::vector<LiveEvent> events = run(200);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].kind, LiveEvent::Kind::tare);
  EXPECT_EQ(events[0].tag, 3U);
  EXPECT_EQ(events[0].recording, "");
  EXPECT_FALSE(session_.is_taring());
  sensor_.reading = 30;
  session_.start_tare(milliseconds(100));
  events = run(200);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].recording, path_) << "it keeps the tare of its start";
  EXPECT_EQ(processor_.tare(), plane_of(30));
  EXPECT_EQ(recorded_tare(), plane_of(20));
}

TEST_F(LiveSessionTest, ARecordingStartsWithTheTareOfTheRun) {
  session_.start_tare(milliseconds(100));
  run(200);
  session_.record(path_);
  EXPECT_THROW(session_.record(path_), Error);
  run(20);
  EXPECT_EQ(recorded_tare(), plane_of(20));
  EXPECT_FALSE(session_.stop_recording());
}

TEST_F(LiveSessionTest, NoFrameIsSolvedBeforeATareThatHolds) {
  session_.start_tare(milliseconds(100), false, 0, true);
  std::uint64_t first = 0;
  const auto sink = callback_sink([&](const SolvedFrame& frame) {
    if (first == 0) first = frame.sequence;
  });
  session_.run({.sink = sink.get(), .stop = [this] { return sensor_.sent >= 50; }});
  EXPECT_TRUE(session_.is_taring());
  session_.run({.sink = sink.get(), .stop = [this] { return sensor_.sent >= 200; }});
  EXPECT_EQ(first, 100U);
  EXPECT_NE(session_.take_events().at(0).note.find("100 frames before it"), std::string::npos);
}

TEST_F(LiveSessionTest, ATareBeingMeasuredIsThatOfTheRecording) {
  session_.start_tare(milliseconds(50));
  run(200);
  sensor_.reading = 40;
  session_.start_tare(milliseconds(50));
  session_.record(path_);
  EXPECT_EQ(run(200)[0].recording, "");
  EXPECT_EQ(recorded_tare(), plane_of(40));
}

/// Readings of 20 counts and a threshold of 0: a tare brings threshold and noise to solver, tracker
/// and recordings.
TEST_F(LiveSessionTest, ATareSetsTheThreshold) {
  ContactTracker tracker(plan_.skin.element_pitch_mm());
  std::size_t contacts = 0;
  const auto count =
      callback_sink([&](const SolvedFrame& frame) { contacts = frame.contacts->contacts.size(); });
  const auto run_on = [&](std::uint64_t frames) {
    const std::uint64_t end = sensor_.sent + frames;
    session_.run({.contacts = &tracker, .sink = count.get(), .stop = [this, end] {
                    return sensor_.sent >= end;
                  }});
  };
  run_on(5);
  EXPECT_EQ(contacts, 1U);
  session_.record(path_);
  session_.start_tare(milliseconds(100));
  run_on(200);
  EXPECT_NE(session_.take_events().at(0).note, "");
  sensor_.reading = 21;  // within the noise of rounding
  run_on(5);
  EXPECT_EQ(contacts, 0U);
  EXPECT_GT(session_.info().skin.threshold_counts, 1);
  EXPECT_GT(tracker.options().noise_n.value_or(0), 0);
  recorded_tare();
  const auto recorded = open_frames(path_);
  EXPECT_EQ(recorded->skin().threshold_counts, session_.info().skin.threshold_counts);
  EXPECT_EQ(recorded->calibration().noise, session_.info().calibration.noise);
}

TEST_F(LiveSessionTest, PausedFramesAreCountedButNotSolved) {
  run(10);
  const HealthReport before = session_.report();
  session_.set_paused(true);
  run(10);
  const HealthReport health = session_.report();
  EXPECT_EQ(health.solved, before.solved);
  EXPECT_EQ(health.stream.frames, sensor_.sent);
  EXPECT_GT(health.stream.rate_hz, 0);
  session_.set_paused(false);
  session_.run({.frames = before.solved + 5});
  EXPECT_EQ(session_.health().solved, before.solved + 5);
}

}  // namespace
}  // namespace pillarfield
