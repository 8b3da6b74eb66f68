#pragma once

// Files that hold every object that the library writes.

#include "pillarfield/calibration_file.h"
#include "pillarfield/force_file.h"
#include "pillarfield/recording.h"
#include "skin/skin_fields.h"
#include "tests/io/sample_contacts.h"
#include "tests/io/sample_files.h"

namespace pillarfield::io_test {

/// The planes in the order of their table.
inline std::vector<std::vector<float>> planes_of(const Calibration& calibration) {
  std::vector<std::vector<float>> planes;
  visit_planes(calibration, [&](const PlaneField&, const auto& plane) {
    planes.emplace_back(plane.begin(), plane.end());
  });
  return planes;
}

inline constexpr std::uint32_t kFullSize = 6;  ///< sensel rows and columns of the recording
inline constexpr std::uint64_t kFullFrames = 5;

inline void write_full_recording(const std::filesystem::path& path) {
  Skin skin;
  skin.rows = skin.cols = kFullSize;
  skin.full_scale_counts = 250;
  const std::vector<float> ones(skin.sensels(), 1.0f);
  Calibration calibration;
  calibration.tare = calibration.gain = calibration.dead_zone = calibration.noise = ones;
  calibration.mask.assign(skin.sensels(), 1);
  RecordingWriter writer(path, skin, SenselType::u8, calibration,
                         {.truth = true, .replace = Replace::anything});
  FrameBuffer frame(SenselType::u8, kFullSize, kFullSize);
  for (std::uint64_t index = 0; index < kFullFrames; ++index) {
    fill_frame(index, frame);
    const ForceField truth = sample_forces(index, skin.pillar_rows(), skin.pillar_cols());
    writer.append(frame.view(), static_cast<double>(index), &truth);
  }
  writer.finish();
}

/// A calibration of 6 x 8 sensels with every member set.
inline SkinCalibration full_calibration() {
  SkinCalibration calibration;
  calibration.rows = 6;
  calibration.cols = 8;
  const auto plane = [](float first) {
    std::vector<float> values(48);
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = first + static_cast<float>(i) / 7.0F;
    }
    return values;
  };
  calibration.planes.tare = plane(-3);
  calibration.planes.gain = plane(0.5F);
  calibration.planes.dead_zone = plane(0);
  calibration.planes.mask.assign(48, 1);
  calibration.planes.noise = plane(0.3F);
  calibration.planes.mask[7] = 0;
  calibration.threshold_counts = 4.125;
  calibration.threshold_factor = 4;
  calibration.counts_per_newton = 317.4;
  calibration.sensel_pitch_mm = 5.08;
  calibration.power_law = {1.2, 96.5};
  calibration.layout = SkinLayout::pillars;
  calibration.planes.bend_x = plane(-40);
  calibration.planes.bend_y = plane(10);
  calibration.planes.bend_xy = plane(0);
  calibration.planes.effects = {.curve = {},
                                .shear_coefficient = {{1.1, 0.9}},
                                .sensel_leak = {{0.05, 0.02}},
                                .pillar_leak = {{0.01, -0.002}},
                                .wires = {{32, 48, 1e-4, 2e-4, 3e-5, TareOrigin::offset}},
                                .memory = {{{{5, 0.02}, {20, 0.03}}, {{0.3, 0.01}}}},
                                .arm_mm = 0.224,
                                .residual = {{0.01, 0.4}}};
  calibration.history = {
      {"tare", {"bare.h5"}, 100, "threshold_factor = 4", "2026-01-31T12:34:56Z", "0.1.0"},
      {"equilibrate", {"a b.h5", "ü,.h5"}, 200, "", "2026-02-01T00:00:00Z", "0.2.0"}};
  return calibration;
}

/// Forces of 2 x 3 pillars on a cylinder, with their contacts.
inline void write_full_forces(const std::filesystem::path& path) {
  ForceFileInfo info = {2, 3, 1.25, "direct", "a device", "press.h5"};
  info.segment_point = 0.75;
  info.first_frame = 7;
  info.effects = full_calibration().planes.effects;
  Surface surface;
  surface.shape = SurfaceShape::cylinder;
  surface.radius_mm = 60;
  surface.axis_deg = 30;
  info.surface = surface;
  info.contacts = ContactOptions{.minimum_pillars = 3, .friction = {.given = 0.5}, .reach_mm = 7};
  info.contacts->surface = info.surface;
  const auto sink = create_force_sink(path, info, Replace::anything);
  for (std::uint64_t index = 0; index < kFullFrames; ++index) {
    const ForceField forces = sample_forces(index, 2, 3);
    const FrameContacts found = sample_contacts(index);
    sink->append({.forces = forces.view(), .contacts = &found, .time_s = found.time_s});
  }
  sink->finish();
}

}  // namespace pillarfield::io_test
