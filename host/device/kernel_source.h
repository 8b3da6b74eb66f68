#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "pillarfield/skin.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// The program of kernels/all.h, embedded in the library; a plan's macros precede it.
std::string_view kernel_program();

/// Pillars that a work-item solves at once: the device's lanes, halved until a row has as many.
constexpr int block_lanes(int lanes, std::uint32_t pillar_cols) {
  while (lanes > 1 && static_cast<std::uint32_t>(lanes) > pillar_cols) lanes /= 2;
  return lanes;
}

/// True if the program of a plan computes with whole numbers; `lanes`: its block_lanes().
[[nodiscard]] bool solves_in_whole_numbers(const SolverPlan& plan, int lanes);

/// The OpenCL C type of a reading.
constexpr const char* sensel_macro(SenselType type) {
  switch (type) {
    case SenselType::u8:
      return "uchar";
    case SenselType::u16:
      return "ushort";
    case SenselType::f32:
      break;
  }
  return "float";
}

}  // namespace pillarfield
