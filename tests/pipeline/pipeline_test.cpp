// Compares a pipeline with the same frames solved, tracked and written one by one.

#include "pillarfield/pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pillarfield/contact_file.h"
#include "pillarfield/error.h"
#include "pillarfield/force_file.h"
#include "pillarfield/status.h"
#include "tests/device/same_bits.h"
#include "tests/device/test_device.h"
#include "tests/io/sample_files.h"

namespace pillarfield {
namespace {

using io_test::bytes_of;
using io_test::error_of;
using io_test::has_all;
using io_test::TemporaryDirectory;
using std::chrono::milliseconds;
using Nanoseconds = std::chrono::nanoseconds;

constexpr Skin kSkin = [] {
  Skin skin;
  skin.rows = 24;
  skin.cols = 40;
  return skin;
}();

SolverPlan plan_of(Estimator estimator = Estimator::direct) {
  SolverPlan plan;
  plan.skin = kSkin;
  plan.estimator = estimator;
  plan.angles = true;
  return plan;
}

double time_of(std::uint64_t frame) { return 0.125 * static_cast<double>(frame); }

/// Two pressed rectangles with uneven readings that move towards each other.
void press(std::uint64_t index, FrameBuffer& frame) {
  const std::uint64_t step = index % 14;
  for (std::uint32_t row = 0; row < kSkin.rows; ++row) {
    for (std::uint32_t col = 0; col < kSkin.cols; ++col) {
      const bool first = row >= 3 && row < 11 && col >= step && col < step + 9;
      const bool second = row >= 7 && row < 19 && col >= 30 - step && col < 37 - step;
      const std::uint64_t place = std::uint64_t{row} * kSkin.cols + col;
      const auto reading = static_cast<std::uint8_t>(40 + io_test::number_at(index, place) % 99);
      frame.readings<std::uint8_t>()[place] = first || second ? reading : std::uint8_t{0};
    }
  }
}

/// Options of a stream of press() frames.
class Presses final : public FrameStream {
 public:
  struct Options {
    std::uint64_t frames = 20;
    bool own_memory = false;                     ///< frames lie in memory of the stream
    std::vector<std::uint64_t> sequence = {};    ///< of the frames and of the end; empty: 0, 1, ...
    std::optional<std::uint64_t> fails_at = {};  ///< index of the failing frame
    std::uint64_t waits_before = ~0ULL;          ///< a timeout comes before this frame
    std::uint32_t rows = kSkin.rows;             ///< sensel rows of its frames
    std::vector<SenselBlock> missing = {};       ///< of every other frame, from the second on
  };
  explicit Presses(Options options) : options_(std::move(options)) {}

  [[nodiscard]] const Skin& skin() const override { return kSkin; }
  [[nodiscard]] SenselType sensel_type() const override { return SenselType::u8; }
  [[nodiscard]] Arrival next(StreamedFrame& frame, Nanoseconds timeout) override {
    if (options_.fails_at == next_) {
      options_.fails_at.reset();
      throw Error("a socket", "the other side is gone", "start it again");
    }
    if (next_ == options_.waits_before && !std::exchange(has_waited_, timeout > milliseconds(0))) {
      return Arrival::timed_out;  // which leaves the number of the frame as it is
    }
    frame.sequence = options_.sequence.empty() ? next_ : options_.sequence.at(next_);
    if (next_ == options_.frames) return Arrival::ended;
    if (options_.own_memory) {
      memory_.push_back(std::make_unique<FrameBuffer>(SenselType::u8, kSkin.rows, kSkin.cols));
    }
    FrameBuffer& buffer = options_.own_memory ? *memory_.back() : frame.buffer;
    press(next_, buffer);
    frame.readings = buffer.view();
    frame.readings.rows = options_.rows;
    frame.missing.clear();
    if (next_ % 2 == 1) frame.missing = options_.missing;
    frame.time_s = time_of(next_);
    frame.arrived = Nanoseconds(1000 + next_);
    ++next_;
    return Arrival::arrived;
  }

 private:
  Options options_;
  std::uint64_t next_ = 0;
  bool has_waited_ = false;
  std::vector<std::unique_ptr<FrameBuffer>> memory_;
};

/// Stores the frames that it receives.
class Notebook final : public ForceSink {
 public:
  struct Frame {
    ForceField forces;
    std::vector<float> theta;
    double time_s;
    std::uint64_t sequence;
    Nanoseconds arrived;
    bool has_contacts;
  };

  void append(const SolvedFrame& frame) override {
    if (before) before(frames.size());
    const ForceFieldView& view = frame.forces;
    Frame kept = {{view.rows, view.cols}, {view.theta.begin(), view.theta.end()},
                  frame.time_s,           frame.sequence,
                  frame.arrived,          frame.contacts != nullptr};
    kept.forces.shear_x.assign(view.shear_x.begin(), view.shear_x.end());
    kept.forces.shear_y.assign(view.shear_y.begin(), view.shear_y.end());
    kept.forces.normal.assign(view.normal.begin(), view.normal.end());
    kept.forces.status.assign(view.status.begin(), view.status.end());
    frames.push_back(std::move(kept));
  }

  std::vector<Frame> frames;
  std::function<void(std::size_t frames)> before;  ///< called before each frame is stored
};

/// Streams the frames of press().
void expect_presses(const Notebook& sink, std::size_t frames) {
  Processor processor(test_device(), plan_of());
  ASSERT_EQ(sink.frames.size(), frames);
  FrameBuffer raw(SenselType::u8, kSkin.rows, kSkin.cols);
  for (std::size_t index = 0; index < frames; ++index) {
    const Notebook::Frame& frame = sink.frames[index];
    press(index, raw);
    processor.submit(raw.view());
    const ForceFieldView expected = processor.receive();
    expect_same_bits(frame.forces.view(), expected);
    expect_same_bits(frame.theta, expected.theta, "theta");
    EXPECT_EQ(frame.time_s, time_of(index));
    EXPECT_EQ(frame.arrived, Nanoseconds(1000 + index));
  }
}

TEST(Pipeline, PassesEveryFrameInOrderToEverySink) {
  for (const auto memory : {Memory::shared, Memory::staged}) {
    for (const int in_flight : {1, 2, 5}) {
      for (const bool own_memory : {false, true}) {
        for (const std::uint64_t count : {0U, 1U, 20U}) {
          Presses stream({.frames = count, .own_memory = own_memory});
          Processor processor(test_device(), plan_of(),
                              {.memory = memory, .frames_in_flight = in_flight});
          Notebook first;
          Notebook second;
          int most_in_flight = 0;
          first.before = [&](std::size_t) {
            most_in_flight = std::max(most_in_flight, processor.in_flight() + 1);
          };
          const PipelineStatistics done =
              Pipeline(stream, processor, {&first, &second}, {.frames_in_flight = in_flight}).run();
          EXPECT_EQ(done.frames, count);
          EXPECT_EQ(done.lost, 0);
          EXPECT_FALSE(done.stopped);
          EXPECT_EQ(most_in_flight, std::min<int>(in_flight, static_cast<int>(count)));
          expect_presses(first, count);
          expect_presses(second, count);
        }
      }
    }
  }
}

TEST(Pipeline, CountsMissingSequenceNumbers) {
  // Three frames are lost in the middle, one before the end, none where the sensor restarts its
  // count after a time-out.
  Presses stream({.frames = 6, .sequence = {90, 91, 95, 96, 3, 4, 6}, .waits_before = 4});
  Processor processor(test_device(), plan_of());
  Notebook sink;
  const PipelineStatistics done = Pipeline(stream, processor, {&sink}).run();
  EXPECT_EQ(done.frames, 6);
  EXPECT_EQ(done.lost, 4);
  std::vector<std::uint64_t> numbers;
  for (const auto& frame : sink.frames) numbers.push_back(frame.sequence);
  EXPECT_EQ(numbers, (std::vector<std::uint64_t>{90, 91, 95, 96, 3, 4}));
}

/// A pillar loses its force with any of its readings, and its contact loses the pillar; other
/// pillars and other frames keep theirs.
void expect_missing_pillars(Estimator estimator) {
  const SenselBlock corner = {.first_row = 5, .rows = 4, .first_col = 0, .cols = 13};
  const SenselBlock beyond = {.first_row = 22, .rows = 99, .first_col = 39, .cols = 99};
  Presses stream({.frames = 10, .missing = {corner, beyond}});
  Processor processor(test_device(), plan_of(estimator));
  Processor reference(test_device(), plan_of(estimator));
  ContactTracker tracker(kSkin.pillar_pitch_mm());
  FrameBuffer raw(SenselType::u8, kSkin.rows, kSkin.cols);
  std::uint64_t index = 0;
  const auto sink = callback_sink([&](const SolvedFrame& frame) {
    press(index, raw);
    reference.submit(raw.view());
    const ForceFieldView whole = reference.receive();
    std::uint64_t pillars = 0;
    for (std::size_t i = 0; i < whole.status.size(); ++i) {
      const std::size_t row = i / whole.cols;
      const std::size_t col = i % whole.cols;
      const bool is_missing = index % 2 == 1 && ((row >= 2 && row < 5 && col < 7) ||
                                                 (row == whole.rows - 1 && col == whole.cols - 1));
      ASSERT_EQ(frame.forces.status[i], is_missing ? status::kInconsistent : whole.status[i]) << i;
      ASSERT_EQ(frame.forces.normal[i], is_missing ? 0 : whole.normal[i]) << i;
      ASSERT_EQ(frame.forces.theta[i], is_missing ? 0 : whole.theta[i]) << i;
      pillars += (frame.forces.status[i] & status::kUsable) != 0 ? 1U : 0U;
    }
    EXPECT_EQ(frame.contacts->total.pillars, pillars);
    ++index;
  });
  EXPECT_EQ(Pipeline(stream, processor, {sink.get()}, {.contacts = &tracker}).run().frames, 10);
  EXPECT_EQ(index, 10);
}

TEST(Pipeline, ReportsPillarsWithoutTheirReadingsAsMissing) {
  expect_missing_pillars(Estimator::direct);
  expect_missing_pillars(Estimator::contact);  // It finds contacts before readings are missed.
}

TEST(Pipeline, DeliversFramesInFlightBeforeItWaits) {
  Presses stream({.frames = 9, .waits_before = 7});
  Processor processor(test_device(), plan_of(), {.frames_in_flight = 5});
  Notebook sink;
  std::size_t delivered_before_the_wait = 0;
  const auto note = [&] {
    if (processor.in_flight() == 0)
      delivered_before_the_wait =
          std::max<std::size_t>(delivered_before_the_wait, sink.frames.size());
    return false;
  };
  Pipeline(stream, processor, {&sink}, {.frames_in_flight = 5, .stop = note}).run();
  EXPECT_EQ(delivered_before_the_wait, 7);
  expect_presses(sink, 9);
}

TEST(Pipeline, DeliversFramesInFlightWhenStopped) {
  Presses stream({.frames = 1000});
  Processor processor(test_device(), plan_of(), {.frames_in_flight = 3});
  Notebook sink;
  Pipeline pipeline(stream, processor, {&sink},
                    {.frames_in_flight = 3, .stop = [&] { return sink.frames.size() >= 5; }});
  const PipelineStatistics done = pipeline.run();
  EXPECT_TRUE(done.stopped);
  EXPECT_EQ(done.frames, 7);  // two were in flight beside the fifth
  EXPECT_EQ(processor.in_flight(), 0);
  expect_presses(sink, 7);
}

TEST(Pipeline, GoesOnAfterAnError) {
  Presses stream({.frames = 12, .fails_at = 6});
  Processor processor(test_device(), plan_of(), {.frames_in_flight = 3});
  Notebook sink;
  Pipeline pipeline(stream, processor, {&sink}, {.frames_in_flight = 3});
  EXPECT_TRUE(has_all(error_of([&] { pipeline.run(); }), {"a socket", "gone", "start it again"}));
  EXPECT_EQ(processor.in_flight(), 0);
  expect_presses(sink, 4);  // two were in flight
  EXPECT_EQ(pipeline.run().frames, 6);
  ASSERT_EQ(sink.frames.size(), 10);
  EXPECT_EQ(sink.frames.back().sequence, 11);
}

TEST(Pipeline, EndsWithTheErrorOfASink) {
  Presses stream({.frames = 12});
  Processor processor(test_device(), plan_of());
  Notebook healthy;
  Notebook full;
  full.before = [](std::size_t frames) {
    if (frames == 4) throw Error("forces.csv", "No space left on device", "free some space");
  };
  Pipeline pipeline(stream, processor, {&healthy, &full});
  EXPECT_TRUE(has_all(error_of([&] { pipeline.run(); }), {"forces.csv", "No space left"}));
  EXPECT_EQ(processor.in_flight(), 0);
  expect_presses(healthy, 5);
  expect_presses(full, 4);
}

TEST(Pipeline, RefusesFramesOfAnotherSizeAndNoFramesInFlight) {
  Presses stream({.frames = 3, .rows = kSkin.rows - 2});
  Processor processor(test_device(), plan_of());
  Notebook sink;
  EXPECT_FALSE(error_of([&] { Pipeline(stream, processor, {&sink}).run(); }).empty());
  EXPECT_TRUE(sink.frames.empty());
  EXPECT_TRUE(
      has_all(error_of([&] { Pipeline(stream, processor, {&sink}, {.frames_in_flight = 0}); }),
              {"pipeline", "0 frames in flight"}));
}

/// A pipeline and explicit calls write the same bytes.
TEST(Pipeline, WritesTheBytesOfExplicitCalls) {
  for (const Estimator estimator : {Estimator::direct, Estimator::contact}) {
    const TemporaryDirectory directory;
    RecordingWriter writer(directory / "r.h5", kSkin, SenselType::u8, {}, {});
    FrameBuffer raw(SenselType::u8, kSkin.rows, kSkin.cols);
    for (std::uint64_t index = 0; index < 30; ++index) {
      press(index, raw);
      writer.append(raw.view(), time_of(index));
    }
    writer.finish();
    const auto source = open_frames(directory / "r.h5");
    SolverPlan plan = plan_of(estimator);
    plan.friction.given = 1.5;  // The tracker gets it only from the processor.
    const ContactOptions options = {.minimum_pillars = 2};
    ForceFileInfo info;
    info.rows = kSkin.rows / 2;
    info.cols = kSkin.cols / 2;
    info.element_pitch_mm = kSkin.pillar_pitch_mm();
    info.angles = true;
    ForceFileInfo with_contacts = info;
    with_contacts.contacts = options;
    const auto sinks_named = [&](const std::string& name) {
      const ContactFileInfo contacts = {info.element_pitch_mm, "r.h5", options};
      std::vector<std::unique_ptr<ForceSink>> sinks;
      sinks.push_back(create_force_sink(directory / (name + "_forces.csv"), info));
      sinks.push_back(create_force_sink(directory / (name + ".npy"), info));
      sinks.push_back(create_force_sink(directory / (name + ".h5"), with_contacts));
      sinks.push_back(create_contact_sink(directory / (name + ".csv"), contacts));
      sinks.push_back(create_contact_sink(directory / (name + ".json"), contacts));
      return sinks;
    };

    const auto sinks = sinks_named("pipeline");
    std::vector<ForceSink*> all(sinks.size());
    std::ranges::transform(sinks, all.begin(), [](const auto& sink) { return sink.get(); });
    Processor processor(test_device(), plan);
    ContactTracker tracker(info.element_pitch_mm, options);
    const auto stream = file_stream(*source);
    const PipelineStatistics done = Pipeline(*stream, processor, all, {.contacts = &tracker}).run();
    for (const auto& sink : sinks) sink->finish();
    EXPECT_EQ(done.frames, 30);

    const auto by_hand = sinks_named("hand");
    Processor other(test_device(), plan);
    ContactTracker follower(info.element_pitch_mm, options);
    std::uint64_t most = 0;
    std::uint64_t last_id = 0;
    for (std::uint64_t index = 0; index < source->frames(); ++index) {
      const double time_s = source->read(index, raw);
      other.submit(raw.view());
      const ForceFieldView forces = other.receive();
      const FrameContacts& found = follower.update(forces, time_s, other.contacts());
      most = std::max<std::uint64_t>(most, found.contacts.size());
      for (const auto& contact : found.contacts) last_id = std::max(last_id, contact.track_id);
      for (const auto& sink : by_hand) {
        sink->append({.forces = forces, .contacts = &found, .time_s = time_s});
      }
    }
    for (const auto& sink : by_hand) sink->finish();
    EXPECT_EQ(done.most_contacts, most);
    EXPECT_EQ(done.contacts, last_id);
    EXPECT_EQ(most, 2);
    EXPECT_GT(last_id, 2);  // they merge and split
    for (const std::string ending : {"_forces.csv", ".npy", ".csv", ".json"}) {
      const std::string bytes = bytes_of(directory / ("pipeline" + ending));
      EXPECT_FALSE(bytes.empty());
      EXPECT_TRUE(bytes == bytes_of(directory / ("hand" + ending))) << ending;
    }
    const ForceFileReader forces(directory / "pipeline.h5");
    const ForceFileReader expected(directory / "hand.h5");
    ASSERT_EQ(forces.frames(), 30);
    ForceField a;
    ForceField b;
    for (std::uint64_t index = 0; index < 30; ++index) {
      EXPECT_EQ(forces.read(index, a), expected.read(index, b));
      expect_same_bits(a.view(), b.view());
      EXPECT_EQ(forces.read_contacts(index).contacts.size(),
                expected.read_contacts(index).contacts.size());
    }
  }
}

}  // namespace
}  // namespace pillarfield
