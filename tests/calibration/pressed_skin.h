#pragma once

#include <cstdint>
#include <vector>

#include "pillarfield/calibration_steps.h"
#include "pillarfield/scene.h"
#include "pillarfield/simulator.h"
#include "pillarfield/tare.h"

namespace pillarfield::core_test {

/// A simulated skin that lies bare or under a uniform pressure. The sensels are the same in each of
/// its presses; the noise is another.
class PressedSkin {
 public:
  PressedSkin(std::uint32_t pillar_rows, std::uint32_t pillar_cols, const SensorModel& sensor) {
    scene_.skin.rows = 2 * pillar_rows;
    scene_.skin.cols = 2 * pillar_cols;
    scene_.sensor = sensor;
  }

  [[nodiscard]] Scene& scene() { return scene_; }
  [[nodiscard]] const Skin& skin() const { return scene_.skin; }

  /// Result of a faultless calibration.
  [[nodiscard]] Calibration truth() const { return Simulator(scene_).calibration(); }

  /// Statistics of `frames` frames in which each pillar carries `force_n` straight down.
  TareFrames press(double force_n, std::uint32_t frames) {
    Scene scene = scene_;
    if (force_n > 0) {
      scene.load = DirectionSweep{.directions = scene.skin.pillar_cols(),
                                  .inclinations = scene.skin.pillar_rows(),
                                  .max_theta_deg = 0,
                                  .magnitudes_n = {force_n}};
    }
    return statistics_of(Simulator(scene), frames);
  }

  TareFrames bare(std::uint32_t frames) { return press(0, frames); }

  TareFrames statistics_of(const Simulator& simulator, std::uint32_t frames) {
    const Skin& skin = simulator.scene().skin;
    TareFrames statistics("frames.h5", skin, simulator.sensel_type());
    FrameBuffer frame(simulator.sensel_type(), skin.rows, skin.cols);
    ForceField truth(skin.pillar_rows(), skin.pillar_cols());
    for (std::uint32_t i = 0; i < frames; ++i) {
      simulator.render(next_frame_++, frame, truth);
      statistics.add(frame.view());
    }
    return statistics;
  }

  SkinCalibration tared() {
    return take_tare(blank_calibration(skin()), bare(100), {}).calibration;
  }

  /// The step after 100 frames of each of these forces on every pillar.
  EquilibrationResult equilibrated(const SkinCalibration& before,
                                   const std::vector<double>& forces_n,
                                   const EquilibrationOptions& options = {}) {
    std::vector<TareFrames> frames;
    frames.reserve(forces_n.size());
    std::vector<UniformPress> presses;
    for (const double force_n : forces_n) {
      frames.push_back(press(force_n, 100));
      presses.push_back({frames.back(), pressure_kpa(force_n)});
    }
    return equilibrate(before, presses, options);
  }

  /// The pressure that puts `force_n` on each pillar.
  [[nodiscard]] double pressure_kpa(double force_n) const {
    return 1000 * force_n / (skin().pillar_pitch_mm() * skin().pillar_pitch_mm());
  }

 private:
  Scene scene_;
  std::uint64_t next_frame_ = 0;
};

}  // namespace pillarfield::core_test
