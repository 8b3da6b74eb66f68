#include "pillarfield/force_file.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <limits>
#include <thread>

#include "pillarfield/recording.h"
#include "tests/io/sample_files.h"

namespace pillarfield {
namespace {

// NOLINTNEXTLINE(google-build-using-namespace): tests of these files
using namespace io_test;

using Names = std::vector<std::string>;

/// Forces with unrelated angles, so that all planes differ.
struct Field {
  ForceField forces;
  std::vector<float> magnitude, theta, phi;

  Field(std::uint64_t index, std::uint32_t rows, std::uint32_t cols)
      : forces(sample_forces(index, rows, cols)),
        magnitude(sample_forces(index + 1000, rows, cols).shear_x),
        theta(sample_forces(index + 1000, rows, cols).shear_y),
        phi(sample_forces(index + 1000, rows, cols).normal) {}

  [[nodiscard]] ForceFieldView view() const {
    ForceFieldView view = forces.view();
    view.magnitude = magnitude;
    view.theta = theta;
    view.phi = phi;
    return view;
  }
};

ForceFileInfo info_of(std::uint32_t rows, std::uint32_t cols, bool angles = false) {
  ForceFileInfo info = {rows, cols, 1.265, "direct", "a device \xc2\xb5", "press.h5", angles};
  if (!angles) return info;
  info.segment_point = 0.75;
  info.effects.shear_coefficient = {0.9, 1.1};
  info.effects.arm_mm = 0.3;
  return info;
}

void write(const std::filesystem::path& path, const ForceFileInfo& info, std::uint64_t frames) {
  const auto sink = create_force_sink(path, info);
  for (std::uint64_t index = 0; index < frames; ++index) {
    const Field field(index, info.rows, info.cols);
    sink->append({.forces = field.view(), .time_s = static_cast<double>(index) / 3});
  }
  sink->finish();
}

TEST(ForceFile, KeepsEverythingOfAnySize) {
  for (const auto& [rows, cols, frames] :
       {std::tuple{1u, 1u, 1100u}, {1u, 9u, 0u}, {3u, 5u, 17u}, {70u, 41u, 5u}}) {
    for (const bool angles : {false, true}) {
      const TemporaryDirectory directory;
      const auto path = directory / "f.h5";
      write(path, info_of(rows, cols, angles), frames);
      EXPECT_EQ(directory.names(), Names{"f.h5"});
      const ForceFileReader reader(path);
      EXPECT_EQ(reader.info().rows, rows);
      EXPECT_EQ(reader.info().cols, cols);
      EXPECT_EQ(reader.info().angles, angles);
      EXPECT_EQ(reader.info().element_pitch_mm, 1.265);
      EXPECT_EQ(reader.info().estimator, "direct");
      EXPECT_EQ(reader.info().segment_point, angles ? std::optional(0.75) : std::nullopt);
      const auto coefficient = reader.info().effects.shear_coefficient;
      EXPECT_EQ(coefficient.has_value(), angles);
      EXPECT_EQ(coefficient.value_or(ShearCoefficient{}).x, angles ? 0.9 : 1);
      EXPECT_EQ(coefficient.value_or(ShearCoefficient{}).y, angles ? 1.1 : 1);
      EXPECT_EQ(reader.info().effects.arm_mm, angles ? std::optional(0.3) : std::nullopt);
      EXPECT_EQ(reader.info().device, "a device \xc2\xb5");
      EXPECT_EQ(reader.info().source, "press.h5");
      EXPECT_TRUE(reader.warnings().empty());
      ASSERT_EQ(reader.frames(), frames);
      ForceField read;
      for (std::uint64_t index = 0; index < frames; ++index) {
        EXPECT_EQ(reader.read(index, read), static_cast<double>(index) / 3);
        const ForceField expected = sample_forces(index, rows, cols);
        EXPECT_EQ(read.shear_x, expected.shear_x);
        EXPECT_EQ(read.shear_y, expected.shear_y);
        EXPECT_EQ(read.normal, expected.normal);
        EXPECT_EQ(read.status, expected.status);
      }
      EXPECT_TRUE(has_all(error_of([&] { reader.read(reader.frames(), read); }), {"has no frame"}));
    }
  }
}

TEST(ForceFile, IsTheSameWhenWrittenAgainLater) {
  const TemporaryDirectory directory;
  write(directory / "a.h5", info_of(3, 5), 17);
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  write(directory / "b.h5", info_of(3, 5), 17);
  EXPECT_TRUE(bytes_of(directory / "a.h5") == bytes_of(directory / "b.h5"));
}

/// A field that is idle but for single pillars, which come and go; some values are −0 and NaN.
ForceField sparse_forces(std::uint64_t index, std::uint32_t rows, std::uint32_t cols) {
  ForceField forces(rows, cols);
  if (index % 5 == 0) return forces;
  for (std::uint64_t touched = 0; touched < 3; ++touched) {
    const std::uint64_t number = number_at(index / 9, touched);
    const std::size_t pillar = number % forces.elements();
    forces.normal[pillar] = static_cast<float>(index) + 0.5F;
    forces.shear_x[pillar] = touched == 0 ? -0.0F : std::numeric_limits<float>::quiet_NaN();
    forces.status[pillar] = touched == 1 ? 0 : 15;  // A value counts, whatever the status.
  }
  return forces;
}

TEST(ForceFile, LeavesOutWhatNothingTouchesAndKeepsEveryBit) {
  for (const auto& [rows, cols, frames] :
       {std::tuple{1u, 1u, 40u}, {13u, 29u, 37u}, {79u, 20u, 16u}, {200u, 333u, 53u}}) {
    const TemporaryDirectory directory;
    const auto path = directory / "f.h5";
    {
      const auto sink = create_force_sink(path, info_of(rows, cols));
      for (std::uint64_t index = 0; index < frames; ++index) {
        const ForceField forces = sparse_forces(index, rows, cols);
        sink->append({.forces = forces.view(), .time_s = static_cast<double>(index)});
      }
      sink->finish();
    }
    const std::uint64_t dense = std::uint64_t{rows} * cols * frames * 13;
    if (rows == 200) {
      EXPECT_LT(std::filesystem::file_size(path), dense / 10);
    }
    const ForceFileReader reader(path);
    ForceField read;
    for (std::uint64_t index : {std::uint64_t{frames - 1}, std::uint64_t{0}}) {
      for (; index < frames; ++index) {
        reader.read(index, read);
        const ForceField expected = sparse_forces(index, rows, cols);
        const auto same = [](const std::vector<float>& a, const std::vector<float>& b) {
          return a.size() == b.size() && std::memcmp(a.data(), b.data(), 4 * a.size()) == 0;
        };
        ASSERT_TRUE(same(read.shear_x, expected.shear_x)) << index;
        ASSERT_TRUE(same(read.normal, expected.normal)) << index;
        ASSERT_EQ(read.status, expected.status) << index;
      }
    }
  }
}

/// Chunks of 16 frames are stored whole: a file of one frame would take 16 times its values.
TEST(ForceFile, OfFewFramesIsSmallWhereTheirNumberIsKnown) {
  const TemporaryDirectory directory;
  constexpr std::uint64_t kValueBytes = std::uint64_t{10'000} * (3 * sizeof(float) + 1);
  constexpr std::uint64_t kHeads = 40'000;
  for (std::uint64_t frames = 1; frames <= 4; ++frames) {
    ForceFileInfo info = info_of(100, 100);
    info.frames = frames;
    const auto path = directory / "few.h5";
    write(path, info, frames);
    EXPECT_LT(std::filesystem::file_size(path), (frames + 1) * kValueBytes + kHeads) << frames;
    info.frames = 1;  // and more come
    write(path, info, 5);
    EXPECT_EQ(ForceFileReader(path).frames(), 5);
  }
}

TEST(ForceSink, RefusesWhatItCannotWrite) {
  const TemporaryDirectory directory;
  const auto refused = [&](const std::filesystem::path& path, const ForceFileInfo& info) {
    return error_of([&] { (void)create_force_sink(path, info); });
  };
  ForceFileInfo no_pitch = info_of(2, 3);
  no_pitch.element_pitch_mm = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(has_all(refused(directory / "f.txt", info_of(2, 3)), {"f.txt", ".h5", ".csv"}));
  EXPECT_TRUE(has_all(refused(directory / "f", info_of(2, 3)), {"extension"}));
  EXPECT_TRUE(has_all(refused(directory / "f.h5", info_of(0, 3)), {"0 x 3"}));
  EXPECT_TRUE(has_all(refused(directory / "f.h5", info_of(2, 32768)), {"2 x 32768"}));
  EXPECT_TRUE(has_all(refused(directory / "f.h5", no_pitch), {"element_pitch_mm is nan"}));
  EXPECT_EQ(directory.names(), Names{});
}

TEST(ForceSink, RefusesFramesThatDoNotFitAndGoesOn) {
  for (const char* name : {"f.h5", "f.hdf5", "f.CSV", "f.npy"}) {
    const TemporaryDirectory directory;
    const auto sink = create_force_sink(directory / name, info_of(2, 3, true));
    const auto refused = [&](const ForceFieldView& view, double time_s) {
      return error_of([&] { sink->append({.forces = view, .time_s = time_s}); });
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(has_all(refused(Field(0, 3, 2).view(), 0), {name, "3 x 2", "2 x 3"}));
    EXPECT_TRUE(has_all(refused(Field(0, 2, 3).forces.view(), 0), {name, "without magnitude"}));
    EXPECT_TRUE(has_all(refused(Field(0, 2, 3).view(), nan), {name, "nan"}));
    sink->append({.forces = Field(0, 2, 3).view()});
    sink->finish();
    EXPECT_TRUE(has_all(refused(Field(0, 2, 3).view(), 0), {name, "is finished"}));
    EXPECT_TRUE(has_all(error_of([&] { sink->finish(); }), {name, "is finished"}));
    EXPECT_EQ(directory.names(), Names{name});
  }
}

TEST(ForceFileReader, RefusesOtherFiles) {
  const TemporaryDirectory directory;
  Skin skin;
  skin.rows = skin.cols = 2;
  RecordingWriter(directory / "r.h5", skin, SenselType::u8, {}, {}).finish();
  write(directory / "f.h5", info_of(2, 3), 3);
  const auto refused = [&](const std::string& name) {
    return error_of([&] { const ForceFileReader reader(directory / name); });
  };
  EXPECT_TRUE(has_all(refused("r.h5"), {"r.h5", "pillarfield-recording", "solve it first"}));
  EXPECT_TRUE(has_all(error_of([&] { (void)open_frames(directory / "f.h5"); }),
                      {"f.h5", "pillarfield-forces", "recording that they were solved from"}));
}

}  // namespace
}  // namespace pillarfield
