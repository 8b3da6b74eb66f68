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
///     dead zone, neighbours, memory (MemoryHistory), response curve or power law,
///     sensitivity, tare, wires (an offset: wires, tare), drift, noise, full scale and rounding,
///     dead.
///
/// Neighbours, memory and wires need whole frames: load() then read_frame(), with memory in
/// between.
class Sensor {
 public:
  /// Draws the per-sensel planes. The scene must pass check().
  explicit Sensor(const Scene& scene);

  [[nodiscard]] SenselType sensel_type() const;
  [[nodiscard]] const Calibration& calibration() const { return calibration_; }

  /// True if a reading depends on other sensels or frames, so that read_row() does not apply.
  [[nodiscard]] bool needs_frames() const { return needs_frames_; }

  /// Dead zone and neighbours of a frame: overwrites the model's V, counts.
  void load(std::span<double> frame_signal) const;

  /// Writes a frame of raw readings from the result of load(), which is overwritten.
  void read_frame(std::uint64_t frame, std::span<double> frame_signal, FrameBuffer& raw) const;

  /// Writes one row of raw readings. `signal` holds the model's V of that row, counts, and is
  /// overwritten.
  void read_row(std::uint64_t frame, std::uint32_t row, std::span<double> signal,
                FrameBuffer& raw) const;

 private:
  void subtract_dead_zone(std::span<double> signal) const;
  void respond(std::uint32_t row, std::span<double> signal) const;
  void add_tares(std::uint64_t frame, std::uint32_t row, std::span<double> signal) const;
  void add_bending(std::uint64_t frame, std::uint32_t row, std::span<double> signal) const;
  void digitise(std::uint64_t frame, std::uint32_t row, std::span<double> signal,
                FrameBuffer& raw) const;
  void add_drift(std::uint64_t frame, std::uint32_t row, std::span<double> signal) const;
  void add_noise(std::uint64_t frame, std::uint32_t row, std::span<double> signal) const;
  void convert(std::uint32_t row, std::span<const double> signal, FrameBuffer& raw) const;
  void clear_dead(std::uint32_t row, std::span<double> signal) const;

  Skin skin_;
  SensorModel model_;
  std::optional<Bending> bending_;
  double full_scale_counts_;
  std::optional<PowerLaw> power_law_;  ///< its inverse
  std::uint64_t seed_;
  std::uint64_t first_frame_of_noise_;  ///< differs between recordings
  double rate_hz_;
  Calibration calibration_;
  std::vector<float> drift_;  ///< rate of each sensel over its standard deviation
  bool needs_frames_;
};

}  // namespace pillarfield
