#pragma once

#include <cstddef>
#include <vector>

#include "pillarfield/frame.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/solver_plan.h"
#include "pillarfield/tuning.h"
#include "solve/pillar_maths.h"
#include "solve/sensor_corrections.h"
#include "solve/wire_factors.h"

namespace pillarfield {

/// Sensels of a frame after the stages of a plan, in single precision as on the device. Plan and
/// frame must fit each other and outlive the reader.
class SenselReader {
 public:
  /// `state` is that of the sensels before the frame; null: at rest.
  SenselReader(const SolverPlan& plan, const FrameView& frame, SensorState* state = nullptr);
  SenselReader(const SenselReader&) = delete;
  SenselReader& operator=(const SenselReader&) = delete;

  /// The four sensels of a pillar after all stages. Call it once for each pillar: it updates the
  /// state.
  [[nodiscard]] single_precision::Pillar pillar(std::size_t row, std::size_t col);

  /// Noise of the four sensels of a pillar after correction, counts.
  [[nodiscard]] single_precision::Noise noise(std::size_t row, std::size_t col) const;

  /// A sensel before the tare: valid, missing or saturated.
  [[nodiscard]] single_precision::Sensel untared(std::size_t row, std::size_t col) const;

  [[nodiscard]] const single_precision::Stages& stages() const { return stages_; }

 private:
  /// Updates the tare of a bent skin.
  void bend(const SolverPlan& plan);
  [[nodiscard]] const std::vector<float>& tares() const;
  /// The reading of a sensel; zero of one that does not exist in the last row or column of quads.
  [[nodiscard]] float reading(std::size_t row, std::size_t col) const;
  [[nodiscard]] bool exists(std::size_t row, std::size_t col) const;
  template <class Value>
  [[nodiscard]] float value_of(const std::vector<Value>& plane, std::size_t row, std::size_t col,
                               Value otherwise) const;
  [[nodiscard]] single_precision::Correction correction(std::size_t row, std::size_t col) const;
  [[nodiscard]] single_precision::Sensel linear(std::size_t row, std::size_t col) const;
  /// A sensel without the leak of its neighbours.
  [[nodiscard]] single_precision::Sensel freed(std::size_t row, std::size_t col) const;
  [[nodiscard]] single_precision::Sensel active(single_precision::Sensel sensel, std::size_t row,
                                                std::size_t col) const;
  [[nodiscard]] float leak_source(std::size_t row, std::size_t col) const;
  [[nodiscard]] single_precision::Sensel without_leak(single_precision::Sensel sensel,
                                                      std::size_t row, std::size_t col) const;
  [[nodiscard]] single_precision::Pillar recalled(const single_precision::Pillar& pillar,
                                                  std::size_t index);
  [[nodiscard]] float sensel_noise(std::size_t row, std::size_t col) const;

  const Calibration& calibration_;
  const FrameView& frame_;
  std::size_t quad_rows_;
  std::size_t quad_cols_;
  single_precision::Stages stages_;
  WireFactors wires_;
  SensorState* state_;
  float noise_;  ///< of a raw reading, counts
};

}  // namespace pillarfield
