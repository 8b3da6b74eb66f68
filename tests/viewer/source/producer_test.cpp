// Fields from every kind of source, compared with its data and the C++ solver.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <thread>

#include "pillarfield/calibration_file.h"
#include "pillarfield/error.h"
#include "pillarfield/force_field.h"
#include "pillarfield/force_file.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/plan_builder.h"
#include "pillarfield/recording.h"
#include "pillarfield/scene.h"
#include "pillarfield/simulator.h"
#include "pillarfield/solver_plan.h"
#include "tests/io/sample_files.h"
#include "tests/viewer/source/touched_field.h"
#include "viewer/source/field_producer.h"
#include "viewer/source/selection.h"

namespace pillarfield::viewer {
template <class Value>
bool same_bytes(std::span<const Value> left, std::span<const Value> right) {
  return std::ranges::equal(std::as_bytes(left), std::as_bytes(right));
}

inline void expect_same_forces(const ForceFieldView& actual, const ForceFieldView& expected) {
  ASSERT_EQ(actual.rows, expected.rows);
  ASSERT_EQ(actual.cols, expected.cols);
  EXPECT_TRUE(same_bytes(actual.shear_x, expected.shear_x));
  EXPECT_TRUE(same_bytes(actual.shear_y, expected.shear_y));
  EXPECT_TRUE(same_bytes(actual.normal, expected.normal));
  EXPECT_TRUE(same_bytes(actual.status, expected.status));
}

inline ForceField copy_of(const ForceFieldView& forces) {
  ForceField copy(forces.rows, forces.cols);
  std::ranges::copy(forces.shear_x, copy.shear_x.begin());
  std::ranges::copy(forces.shear_y, copy.shear_y.begin());
  std::ranges::copy(forces.normal, copy.normal.begin());
  std::ranges::copy(forces.status, copy.status.begin());
  return copy;
}

/// The viewer's plan for a scene with known noise.
inline SolverPlan plan_of(const Simulator& simulator) {
  SolverPlan plan;
  plan.skin = simulator.scene().skin;
  plan.sensel_type = simulator.sensel_type();
  plan.calibration = simulator.calibration();
  set_solver(plan, simulator.scene());
  plan.uncertainty = true;
  return plan;
}

namespace {

using io_test::error_of;
using io_test::fill_frame;
using io_test::has_all;
using io_test::sample_forces;
using io_test::TemporaryDirectory;
using io_test::write_bytes;

const std::filesystem::path kDemo = std::filesystem::path(PILLARFIELD_SCENES) / "demo.toml";

/// Expects magnitude, theta and phi of the forces.
void expect_angles(const ForceFieldView& forces) {
  ASSERT_EQ(forces.phi.size(), forces.normal.size());
  for (std::size_t i = 0; i < forces.normal.size(); ++i) {
    const Direction direction =
        direction_of(forces.shear_x[i], forces.shear_y[i], forces.normal[i]);
    ASSERT_FLOAT_EQ(forces.magnitude[i], direction.magnitude);
    ASSERT_NEAR(forces.theta[i], direction.theta, 1e-6);
    const double turn = std::remainder(forces.phi[i] - direction.phi, 2 * std::numbers::pi);
    ASSERT_NEAR(turn, 0, 1e-6);
  }
}

/// Expects whole pages that contain every plane.
void expect_pages(const ShownField& field) {
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(field.pages.data()) % 4096, 0U);
  EXPECT_EQ(field.pages.size() % 4096, 0U);
  const ForceFieldView& forces = field.forces;
  std::vector<std::span<const std::byte>> planes = {std::as_bytes(forces.status)};
  for (const auto plane : {forces.shear_x, forces.shear_y, forces.normal, forces.magnitude,
                           forces.theta, forces.phi}) {
    planes.push_back(std::as_bytes(plane));
  }
  for (const auto plane : forces.uncertainty) planes.push_back(std::as_bytes(plane));
  for (const auto plane : planes) {
    if (plane.empty()) continue;
    EXPECT_GE(plane.data(), field.pages.data());
    EXPECT_LE(plane.data() + plane.size(), field.pages.data() + field.pages.size());
  }
}

TEST(SceneProducer, SolvesTheFramesOfTheSceneInAnyOrder) {
  const Simulator simulator(load_scene(kDemo));
  const SolverPlan plan = plan_of(simulator);
  FrameBuffer frame(plan.sensel_type, plan.skin.rows, plan.skin.cols);
  ForceField truth(plan.skin.pillar_rows(), plan.skin.pillar_cols());
  for (const Memory memory : {Memory::automatic, Memory::staged}) {
    const auto producer = open_producer(kDemo, {.memory = memory, .most_frames = 4});
    for (const std::uint64_t index : {3U, 0U, 2U, 2U}) {
      const ShownField field = producer->produce(index);
      simulator.render(index, frame, truth);
      expect_same_forces(field.forces, solve_on_host(plan, frame.view()).view());
      expect_angles(field.forces);
      expect_pages(field);
      EXPECT_EQ(field.index, index);
      EXPECT_EQ(field.time_s, simulator.time_of(index));
      const auto* const raw = static_cast<const std::byte*>(field.raw.data);
      EXPECT_TRUE(std::ranges::equal(std::span(raw, frame.bytes().size()), frame.bytes()));
      EXPECT_FALSE(field.forces.uncertainty[Uncertainty::theta_low].empty());
    }
  }
}

TEST(SceneProducer, ProgressRisesAndMayStopTheSimulation) {
  std::vector<double> shares;
  const auto thread = std::this_thread::get_id();
  const auto record = [&](double share) {
    EXPECT_EQ(std::this_thread::get_id(), thread);
    shares.push_back(share);
  };
  static_cast<void>(open_producer(kDemo, {.most_frames = 8}, record));
  ASSERT_FALSE(shares.empty());
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  EXPECT_GE(shares.front(), 0);
  EXPECT_EQ(shares.back(), 1);
  struct Stopped {};
  EXPECT_THROW(static_cast<void>(open_producer(kDemo, {}, [](double) { throw Stopped(); })),
               Stopped);
}

/// Expects that fields of any source stay valid, up to kMostShown.
void expect_fields_stay(FieldProducer& producer) {
  const std::uint64_t frames = producer.info().frames;
  std::vector<ShownField> shown = {producer.produce(0)};
  const ForceField first = copy_of(shown[0].forces);
  for (std::uint64_t i = 0; i < 20; ++i) {
    const ShownField field = producer.produce(i % frames);
    EXPECT_NE(field.pages.data(), shown[0].pages.data());
    EXPECT_EQ(field.index, i % frames);
  }
  expect_same_forces(shown[0].forces, first.view());
  while (shown.size() < FieldProducer::kMostShown) shown.push_back(producer.produce(1));
  const std::string error = error_of([&] { static_cast<void>(producer.produce(0)); });
  EXPECT_TRUE(has_all(error, {"6 fields are in use", "release one"}));
  expect_same_forces(shown[0].forces, first.view());
  std::jthread([&] { shown.pop_back(); }).join();
  shown.push_back(producer.produce(0));
  expect_same_forces(shown.back().forces, first.view());
  if (producer.info().has_readings) {
    EXPECT_NE(shown.back().raw.data, nullptr);
  } else {
    EXPECT_EQ(shown.back().raw.data, nullptr);
  }
}

constexpr std::uint64_t kFrames = 5;

Skin small_skin() {
  Skin skin;
  skin.rows = 31;
  skin.cols = 46;
  skin.sensel_pitch_mm = 0.5;
  return skin;
}

void write_recording(const std::filesystem::path& path, const Calibration& calibration,
                     double interval_s) {
  const Skin skin = small_skin();
  RecordingWriter writer(path, skin, SenselType::u16, calibration, {});
  FrameBuffer frame(SenselType::u16, skin.rows, skin.cols);
  for (std::uint64_t index = 0; index < kFrames; ++index) {
    fill_frame(index, frame);
    writer.append(frame.view(), 7 + interval_s * static_cast<double>(index));
  }
  writer.finish();
}

void write_forces(const std::filesystem::path& path, bool uncertainty) {
  ForceFileInfo info = {19, 23, 1.3, "direct", "a device", "press.h5", false, uncertainty};
  const auto sink = create_force_sink(path, info);
  for (std::uint64_t index = 0; index < kFrames; ++index) {
    ForceField forces = sample_forces(index, info.rows, info.cols);
    if (uncertainty) {
      for (auto& plane : forces.uncertainty) {
        plane = sample_forces(index + 100, info.rows, info.cols).normal;
      }
      forces.uncertainty[Uncertainty::magnitude_high].assign(forces.elements(), 0.25F);
    }
    sink->append({.forces = forces.view(), .time_s = 0.005 * static_cast<double>(index)});
  }
  sink->finish();
}

TEST(RecordingProducer, SolvesWhatIsReadOnDemand) {
  const TemporaryDirectory directory;
  const auto path = directory / "r.h5";
  Calibration calibration;
  calibration.noise.assign(small_skin().sensels(), 0.5F);
  write_recording(path, calibration, 0.004);
  const auto producer = open_producer(path, {});
  const SourceInfo& info = producer->info();
  EXPECT_EQ(info.kind, "recording");
  EXPECT_EQ(info.frames, kFrames);
  EXPECT_NEAR(info.rate_hz, 250, 1e-6);
  EXPECT_TRUE(info.has_uncertainty);
  // Random frames are noisier than stated, which is allowed for, as by `solve`.
  EXPECT_GT(info.calibration.noise.front(), calibration.noise.front());
  SolverPlan plan;
  plan.skin = small_skin();
  plan.sensel_type = SenselType::u16;
  plan.calibration = info.calibration;
  plan.uncertainty = true;
  FrameBuffer frame(SenselType::u16, plan.skin.rows, plan.skin.cols);
  std::vector<ShownField> shown;
  for (const std::uint64_t index : {4U, 1U, 0U}) {
    shown.push_back(producer->produce(index));
    EXPECT_DOUBLE_EQ(shown.back().time_s, 7 + 0.004 * static_cast<double>(index));
  }
  for (const ShownField& field : shown) {
    fill_frame(field.index, frame);
    expect_same_forces(field.forces, solve_on_host(plan, frame.view()).view());
    expect_angles(field.forces);
    expect_pages(field);
    const auto* const raw = static_cast<const std::byte*>(field.raw.data);
    EXPECT_TRUE(std::ranges::equal(std::span(raw, frame.bytes().size()), frame.bytes()))
        << "readings of another frame";
  }
  EXPECT_THROW(static_cast<void>(producer->produce(kFrames)), Error);
}

TEST(RecordingProducer, SolvesEachFormatWithACalibrationAsSolveDoes) {
  const TemporaryDirectory directory;
  const Skin skin = small_skin();
  write_recording(directory / "r.h5", {}, 0.01);
  std::string header = "{'descr': '<u2', 'fortran_order': False, 'shape': (5, 31, 46), }";
  header.resize(117, ' ');
  std::string npy = std::string("\x93NUMPY\x01\x00", 8) + std::string("v\0", 2) + header + '\n';
  std::string csv;
  FrameBuffer frame(SenselType::u16, skin.rows, skin.cols);
  for (std::uint64_t index = 0; index < kFrames; ++index) {
    fill_frame(index, frame);
    npy.append(reinterpret_cast<const char*>(frame.bytes().data()), frame.bytes().size());
    for (const auto reading : frame.readings<std::uint16_t>()) csv += std::to_string(reading) + ",";
    csv.back() = '\n';
  }
  write_bytes(directory / "r.npy", npy);
  write_bytes(directory / "r.csv", csv);
  SkinCalibration calibration = blank_calibration(skin);
  calibration.counts_per_newton = 77;
  calibration.planes.gain.assign(skin.sensels(), 1.25F);
  write_calibration_file(directory / "c.h5", calibration);
  ProducerOptions options;
  options.plan.calibration = directory / "c.h5";
  write_forces(directory / "f.h5", false);
  EXPECT_TRUE(has_all(error_of([&] { (void)open_producer(directory / "f.h5", options); }),
                      {"f.h5", "leave out --calibration"}));
  for (const char* const name : {"r.h5", "r.npy", "r.csv"}) {
    SCOPED_TRACE(name);
    options.plan.read.layout = SkinLayout::pillars;
    if (name[2] != 'h') options.plan.read.rate_hz = 100;
    if (name[2] == 'c') options.plan.read.frame_size = FrameSize{skin.rows, skin.cols};
    const auto producer = open_producer(directory / name, options);
    const auto source = open_frames(directory / name, frame_options(options.plan));
    const SolverPlan plan = build_plan(plan_of_frames(*source), options.plan, name, {});
    EXPECT_EQ(plan.skin.counts_per_newton, 77);
    FrameBuffer read(plan.sensel_type, skin.rows, skin.cols);
    source->read(3, read);
    expect_same_forces(producer->produce(3).forces, solve_on_host(plan, read.view()).view());
  }
}

TEST(SceneProducer, OpensAgain) {
  const auto producer = open_producer(PILLARFIELD_SCENES "/touch/sliding.toml", {.most_frames = 3});
  const auto again = producer->open_again();
  EXPECT_EQ(again->info().frames, 3U);
  for (std::uint64_t index = 0; index < 3; ++index) {
    expect_same_forces(again->produce(index).forces, producer->produce(index).forces);
  }
}

TEST(ForceFileProducer, ShowsWhatTheFileHasAndAngles) {
  for (const bool uncertainty : {false, true}) {
    const TemporaryDirectory directory;
    const auto path = directory / "f.h5";
    write_forces(path, uncertainty);
    const auto producer = open_producer(path, {.device = "a device that does not exist"});
    const SourceInfo& info = producer->info();
    EXPECT_EQ(info.kind, "force field");
    EXPECT_EQ(info.solver, "direct on a device");
    EXPECT_EQ(info.skin.pillar_rows(), 19U);
    EXPECT_DOUBLE_EQ(info.skin.pillar_pitch_mm(), 1.3);
    EXPECT_NEAR(info.rate_hz, 200, 1e-6);
    EXPECT_EQ(info.has_uncertainty, uncertainty);
    EXPECT_FALSE(info.has_readings);
    for (const std::uint64_t index : {3U, 0U, 4U}) {
      const ShownField field = producer->produce(index);
      expect_same_forces(field.forces, sample_forces(index, 19, 23).view());
      expect_angles(field.forces);
      expect_pages(field);
      EXPECT_DOUBLE_EQ(field.time_s, 0.005 * static_cast<double>(index));
      if (!uncertainty) continue;
      const ForceField other = sample_forces(index + 100, 19, 23);
      EXPECT_TRUE(same_bytes<float>(field.forces.uncertainty[Uncertainty::shear_x], other.normal));
      EXPECT_EQ(field.forces.uncertainty[Uncertainty::magnitude_high][7], 0.25F);
    }
  }
}

/// Two moving indenters; the left one is absent in frame 2.
ShownField passing(std::uint64_t index) {
  const auto col = static_cast<std::uint32_t>(index);
  const Touch left{{2, 6, 2 + col, 6 + col}};
  const Touch right{{12, 16, 20 - col, 24 - col}, 2};
  return index == 2 ? touched_field(index, 20, 30, {right})
                    : touched_field(index, 20, 30, {left, right});
}

/// Writes the fields, with contacts of at least two pillars.
void write_passing(const std::filesystem::path& path) {
  ForceFileInfo info = {20, 30, 1.3, "direct", "a device", "press.h5", false, false};
  info.contacts = ContactOptions{.minimum_pillars = 2};
  const auto sink = create_force_sink(path, info);
  ContactTracker tracker(info.element_pitch_mm, *info.contacts);
  for (std::uint64_t index = 0; index < kFrames; ++index) {
    const ShownField field = passing(index);
    const FrameContacts& found = tracker.update(field.forces, field.time_s);
    sink->append({.forces = field.forces, .contacts = &found, .time_s = field.time_s});
  }
  sink->finish();
}

std::vector<std::uint64_t> ids_of(const ShownContacts& contacts) {
  std::vector<std::uint64_t> ids;
  for (const auto& contact : contacts.found.contacts) ids.push_back(contact.track_id);
  return ids;
}

TEST(ForceFileProducer, ContactsOfTheFileKeepTheirIdsInWhateverOrderTheyAreSeen) {
  const TemporaryDirectory directory;
  write_passing(directory / "c.h5");
  const auto producer = open_producer(directory / "c.h5", {});
  const auto at = [&](std::uint64_t index) {
    return producer->contacts_of(producer->produce(index));
  };
  EXPECT_EQ(ids_of(at(4)), (std::vector<std::uint64_t>{3, 2}));
  EXPECT_EQ(ids_of(at(0)), (std::vector<std::uint64_t>{1, 2}));
  EXPECT_EQ(ids_of(at(2)), (std::vector<std::uint64_t>{2}));
  const ShownContacts contacts = at(3);
  ASSERT_EQ(contacts.extents.size(), 2U);
  EXPECT_EQ(contacts.extents[1].row_begin, 12U);
  EXPECT_EQ(contacts.extents[1].col_begin, 17U);
  EXPECT_EQ(contacts.heaviest, (std::vector<std::size_t>{1, 0}));
}

TEST(FieldProducer, FieldsStayWhateverTheSource) {
  const TemporaryDirectory directory;
  write_recording(directory / "r.h5", {}, 0.01);
  write_forces(directory / "f.h5", true);
  for (const Memory memory : {Memory::automatic, Memory::staged}) {
    const ProducerOptions options = {.memory = memory, .most_frames = 3};
    for (const auto& path : {kDemo, directory / "r.h5", directory / "f.h5"}) {
      expect_fields_stay(*open_producer(path, options));
    }
  }
}

TEST(FieldProducer, FieldsOutliveTheirProducer) {
  const TemporaryDirectory directory;
  write_recording(directory / "r.h5", {}, 0.01);
  write_forces(directory / "f.h5", false);
  for (const auto& path : {kDemo, directory / "r.h5", directory / "f.h5"}) {
    auto producer = open_producer(path, {.most_frames = 2});
    const ShownField field = producer->produce(1);
    const ForceField before = copy_of(field.forces);
    producer.reset();
    expect_same_forces(field.forces, before.view());
  }
}

/// A ball with growing shear: the friction observed in frame 4 sharpens frame 5.
constexpr const char* kGrowingShear =
    "[skin]\nsize_mm = [30, 30]\n[solver]\nestimator = \"contact\"\n"
    "[sensor]\nnoise_counts = 0.3\n[time]\nframes = 6\n"
    "[[contact]]\nshape = \"sphere\"\nmotion = \"press\"\ncontact_radius_mm = 8\n"
    "path = [{ time_s = 0, position_mm = [0, 0], load_n = 30 },\n"
    "        { time_s = 0.05, position_mm = [0, 0], load_n = 3 }]\n"
    "[[contact]]\nshape = \"sphere\"\nmotion = \"slide\"\ncontact_radius_mm = 8\n"
    "friction = 1.9\ndirection_deg = 0\n"
    "path = [{ time_s = 0, position_mm = [0, 0], load_n = 3 },\n"
    "        { time_s = 0.05, position_mm = [0, 0], load_n = 30 }]\n";

class FramesInOrder : public testing::Test {
 protected:
  FramesInOrder() { write_bytes(path_, kGrowingShear); }

  TemporaryDirectory directory_;
  std::filesystem::path path_ = directory_ / "growing.toml";
};

TEST_F(FramesInOrder, HaveNoPriorAfterAJump) {
  const auto producer = open_producer(path_, {});
  const ForceField alone = copy_of(producer->produce(5).forces);
  for (const std::uint64_t before : {0U, 3U, 5U}) {
    static_cast<void>(producer->produce(before));
    expect_same_forces(producer->produce(5).forces, alone.view());
  }
  static_cast<void>(producer->produce(4));
  EXPECT_FALSE(std::ranges::equal(producer->produce(5).forces.normal, alone.normal));
}

TEST(FrameRate, IsOfTheMedianStep) {
  const std::vector<double> times = {5, 5.01, 5.02, 9.0, 9.01, 9.02};
  const auto time_of = [&](std::uint64_t index) { return times.at(index); };
  EXPECT_NEAR(frame_rate(times.size(), time_of), 100, 1e-6);
  EXPECT_EQ(frame_rate(1, time_of), 100);
  EXPECT_EQ(frame_rate(5, [](std::uint64_t) { return 3.0; }), 100);
  EXPECT_EQ(frame_rate(5, [](std::uint64_t index) { return -2.0 * double(index); }), 100);
  EXPECT_EQ(frame_rate(5, [](std::uint64_t) { return std::nan(""); }), 100);
  EXPECT_NEAR(frame_rate(5, [](std::uint64_t index) { return 0.5 * double(index); }), 2, 1e-9);
}

}  // namespace
}  // namespace pillarfield::viewer
