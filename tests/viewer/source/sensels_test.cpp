// Skins of bare sensels from every kind of source: one element for each reading, normal force
// alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "pillarfield/force_file.h"
#include "pillarfield/recording.h"
#include "pillarfield/status.h"
#include "tests/io/sample_files.h"
#include "tests/viewer/source/solved_scene.h"
#include "viewer/source/field_producer.h"
#include "viewer/source/plane_block.h"
#include "viewer/source/player.h"
#include "viewer/source/selection.h"

namespace pillarfield::viewer {
namespace {

using io_test::TemporaryDirectory;

constexpr std::uint32_t kBareRows = 13;  // Odd sizes have no pillar in their last row and column.
constexpr std::uint32_t kBareCols = 7;
constexpr std::uint64_t kBareFrames = 4;

Skin bare_skin() {
  Skin skin;
  skin.layout = SkinLayout::sensels;
  skin.rows = kBareRows;
  skin.cols = kBareCols;
  skin.sensel_pitch_mm = 3;
  skin.counts_per_newton = 50;
  skin.threshold_counts = 10;
  return skin;
}

std::uint16_t bare_reading(std::uint64_t frame, std::size_t place) {
  return static_cast<std::uint16_t>((frame + 1) * (place % 19) * 7);
}

void write_bare_recording(const std::filesystem::path& path) {
  Calibration calibration;
  calibration.noise.assign(bare_skin().sensels(), 0.5F);
  RecordingWriter writer(path, bare_skin(), SenselType::u16, calibration, {});
  FrameBuffer frame(SenselType::u16, kBareRows, kBareCols);
  for (std::uint64_t index = 0; index < kBareFrames; ++index) {
    for (std::size_t i = 0; i < bare_skin().sensels(); ++i) {
      frame.readings<std::uint16_t>()[i] = bare_reading(index, i);
    }
    writer.append(frame.view(), 0.01 * static_cast<double>(index));
  }
  writer.finish();
}

/// Expects the readings above the threshold over the counts per newton.
void expect_bare_forces(const ForceFieldView& forces, std::uint64_t index) {
  ASSERT_EQ(forces.rows, kBareRows);
  ASSERT_EQ(forces.cols, kBareCols);
  for (const auto plane :
       {forces.shear_x, forces.shear_y, forces.magnitude, forces.theta, forces.phi,
        forces.uncertainty[Uncertainty::shear_x], forces.uncertainty[Uncertainty::phi_low]}) {
    EXPECT_TRUE(plane.empty());
  }
  for (std::size_t i = 0; i < forces.normal.size(); ++i) {
    const std::uint16_t counts = bare_reading(index, i);
    const bool usable = counts > 10;
    EXPECT_FLOAT_EQ(forces.normal[i], usable ? static_cast<float>(counts) / 50 : 0);
    EXPECT_EQ(forces.status[i], usable ? status::kSensel1 : 0);
  }
}

TEST(SenselsProducer, SolvesARecordingOfBareSensels) {
  const TemporaryDirectory directory;
  write_bare_recording(directory / "r.h5");
  const auto producer = open_producer(directory / "r.h5", {});
  const SourceInfo& info = producer->info();
  EXPECT_FALSE(info.skin.has_pillars());
  EXPECT_TRUE(info.has_readings && info.has_uncertainty);
  EXPECT_FALSE(info.has_angles);
  EXPECT_EQ(info.solver.find("direct"), std::string::npos);
  for (const std::uint64_t index : {3U, 0U, 1U}) {
    const ShownField field = producer->produce(index);
    expect_bare_forces(field.forces, index);
    EXPECT_FALSE(field.forces.uncertainty[Uncertainty::normal].empty());
    const ShownContacts contacts = producer->contacts_of(field);
    EXPECT_FALSE(contacts.found.total.has_shear);
    EXPECT_NEAR(contacts.found.total.normal_n,
                sums_over(field, {0, kBareRows, 0, kBareCols}, 3).normal, 1e-6);
  }
}

TEST(SenselsProducer, ShowsAFileOfTheirForces) {
  const TemporaryDirectory directory;
  write_bare_recording(directory / "r.h5");
  const auto solved = open_producer(directory / "r.h5", {});
  ForceFileInfo file;
  file.rows = kBareRows;
  file.cols = kBareCols;
  file.element_pitch_mm = 3;
  file.estimator = "direct";
  file.device = "a device";
  file.uncertainty = true;
  file.layout = SkinLayout::sensels;
  const auto sink = create_force_sink(directory / "f.h5", file);
  for (std::uint64_t index = 0; index < kBareFrames; ++index) {
    sink->append({.forces = solved->produce(index).forces, .time_s = 0.01 * double(index)});
  }
  sink->finish();
  const auto producer = open_producer(directory / "f.h5", {});
  const SourceInfo& info = producer->info();
  EXPECT_FALSE(info.skin.has_pillars());
  EXPECT_EQ(info.skin.element_pitch_mm(), 3);
  EXPECT_FALSE(info.has_angles || info.has_readings);
  EXPECT_TRUE(info.has_uncertainty);
  EXPECT_EQ(info.solver, "a device");
  const ShownField field = producer->produce(2);
  expect_bare_forces(field.forces, 2);
  EXPECT_TRUE(same_bytes(field.forces.uncertainty[Uncertainty::normal],
                         solved->produce(2).forces.uncertainty[Uncertainty::normal]));
  EXPECT_FALSE(producer->contacts_of(field).found.total.has_shear);
}

TEST(SenselsPeak, IsTheLargestForceOfEachSensel) {
  const TemporaryDirectory directory;
  write_bare_recording(directory / "r.h5");
  const auto producer = open_producer(directory / "r.h5", {});
  PeakHold hold;
  for (const std::uint64_t index : {0U, 3U, 1U}) hold.add(producer->produce(index).forces);
  const auto peak = hold.field(producer->produce(1));
  ASSERT_NE(peak, nullptr);
  expect_bare_forces(peak->forces, 3);
}

}  // namespace
}  // namespace pillarfield::viewer
