#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pillarfield/calibration.h"
#include "pillarfield/frame.h"
#include "pillarfield/scene.h"

namespace pillarfield {

/// The sensels of a scene: the stages from the model's V to the raw reading, in this order, each
/// only if the scene lists it (docs/scenes.md):
///
///     dead zone, power law, sensitivity, tare, drift, noise, full scale and rounding, dead.
class Sensor {
 public:
  /// Draws the per-sensel planes. The scene must pass check().
  explicit Sensor(const Scene& scene);

  [[nodiscard]] SenselType sensel_type() const;
  [[nodiscard]] const Calibration& calibration() const { return calibration_; }

  /// Writes one row of raw readings. `signal` holds the model's V of that row, counts, and is
  /// overwritten.
  void read_row(std::uint64_t frame, std::uint32_t row, std::span<double> signal,
                FrameBuffer& raw) const;

 private:
  void respond(std::uint32_t row, std::span<double> signal) const;
  void add_drift(std::uint64_t frame, std::uint32_t row, std::span<double> signal) const;
  void add_noise(std::uint64_t frame, std::uint32_t row, std::span<double> signal) const;
  void convert(std::uint32_t row, std::span<const double> signal, FrameBuffer& raw) const;
  void clear_dead(std::uint32_t row, std::span<double> signal) const;

  SensorModel model_;
  double full_scale_counts_;
  std::optional<PowerLaw> bend_;  ///< inverse of the power law
  std::uint64_t seed_;
  double rate_hz_;
  Calibration calibration_;
};

}  // namespace pillarfield
