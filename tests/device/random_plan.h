#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// A frame of random readings with a stride of its own, a mix of all regions: a third of the
/// readings is zero, some are saturated, and float32 ones are also negative, NaN or infinite.
class RandomFrame {
 public:
  RandomFrame(const SolverPlan& plan, std::size_t padding, std::uint32_t seed);
  [[nodiscard]] FrameView view() const;

 private:
  Skin skin_;
  SenselType type_;
  std::size_t row_stride_;
  std::vector<std::uint8_t> u8_;
  std::vector<std::uint16_t> u16_;
  std::vector<float> f32_;
};

/// A plan for a skin of rows x cols sensels without optional stages.
SolverPlan bare_plan(std::uint32_t rows, std::uint32_t cols, SenselType type);

/// A plan with saturation, parity test and all calibration planes.
SolverPlan full_plan(std::uint32_t rows, std::uint32_t cols, SenselType type, std::uint32_t seed);

}  // namespace pillarfield
