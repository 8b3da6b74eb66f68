#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "solve/pillar_maths.h"

namespace pillarfield {

/// Indices of the calibration planes that a plan has; the others are not read.
struct LanePlanes {
  std::size_t tare = 0;
  std::size_t gain = 0;
  std::size_t dead_zone = 0;
  std::size_t noise = 0;
  std::size_t mask = 0;
  std::size_t activation = 0;
  std::size_t bend_x = 0;
  std::size_t bend_y = 0;
  std::size_t bend_xy = 0;
  std::size_t release = 0;
  std::size_t memory = 0;
  bool has_noise = false;
};

/// Part of a plan that a program of lanes knows, and that OpenCL programs have as macros.
struct LanePlan {
  single_precision::Stages stages{};  ///< with numbers in units of whole ones, if `whole`
  bool whole = false;                 ///< counts are whole numbers: 8-bit readings as they are
  LanePlanes planes;
  std::uint32_t tile_rows = 2;  ///< sensels of a tile of wires (WireCrosstalk)
  std::uint32_t tile_cols = 2;
};

/// Work-items of a launch, as OpenCL numbers them: two dimensions.
struct LaneRange {
  std::size_t across = 1;
  std::size_t down = 1;
};

/// A frame and the memory of its results, as the entry points of kernels/frame take them.
struct LaneFrame {
  const void* raw = nullptr;  ///< float, or bytes if the plan is whole
  unsigned char* calibration = nullptr;
  unsigned char* results = nullptr;
  single_precision::Layout layout{};
};

/// The entry points of kernels/frame, compiled for one instruction set. Each runs the work-items
/// [first, last) of those along `down` of a range.
struct LaneProgram {
  const char* name = nullptr;  ///< of the instruction set: "AVX-512"
  int lanes = 0;               ///< pillars of a block, but of whole numbers
  int whole_lanes = 0;
  using Run = void (*)(const LanePlan& plan, const LaneFrame& frame, LaneRange range,
                       std::size_t first, std::size_t last);
  Run find_wires = nullptr;
  Run solve_frame = nullptr;
  Run remove_pillar_leak = nullptr;
  Run find_shear_ratios = nullptr;
  Run correct_forces = nullptr;
  void (*bend_tare)(const LanePlan& plan, const LaneFrame& frame,
                    const single_precision::Curvature& change) = nullptr;
  void (*follow_baseline)(const LanePlan& plan, const LaneFrame& frame,
                          const single_precision::BaselinePace& pace,
                          const single_precision::Drift& drift, std::uint32_t first_row,
                          std::uint32_t interval) = nullptr;
};

/// The programs that this processor runs, those with the most lanes first.
[[nodiscard]] std::span<const LaneProgram* const> lane_programs();

/// The one with the most lanes, but not more than `most` if there is one, that a row of so many
/// blocks of 2 x 2 sensels fills; that with the fewest lanes if none does.
[[nodiscard]] const LaneProgram& lane_program(std::uint32_t quad_cols, int most);

}  // namespace pillarfield
