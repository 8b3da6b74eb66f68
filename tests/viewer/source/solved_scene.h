#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <span>

#include "pillarfield/force_field.h"
#include "pillarfield/simulator.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield::viewer {

template <class Value>
bool same_bytes(std::span<const Value> left, std::span<const Value> right) {
  return std::ranges::equal(std::as_bytes(left), std::as_bytes(right));
}

inline void expect_same_forces(const ForceFieldView& actual, const ForceFieldView& expected) {
  ASSERT_EQ(actual.rows, expected.rows);
  ASSERT_EQ(actual.cols, expected.cols);
  EXPECT_TRUE(same_bytes(actual.shear_x, expected.shear_x));
  EXPECT_TRUE(same_bytes(actual.shear_y, expected.shear_y));
  EXPECT_TRUE(same_bytes(actual.normal, expected.normal));
  EXPECT_TRUE(same_bytes(actual.status, expected.status));
}

inline ForceField copy_of(const ForceFieldView& forces) {
  ForceField copy(forces.rows, forces.cols);
  std::ranges::copy(forces.shear_x, copy.shear_x.begin());
  std::ranges::copy(forces.shear_y, copy.shear_y.begin());
  std::ranges::copy(forces.normal, copy.normal.begin());
  std::ranges::copy(forces.status, copy.status.begin());
  return copy;
}

/// The viewer's plan for a scene with known noise.
inline SolverPlan plan_of(const Simulator& simulator) {
  SolverPlan plan;
  plan.skin = simulator.scene().skin;
  plan.sensel_type = simulator.sensel_type();
  plan.calibration = simulator.calibration();
  set_solver(plan, simulator.scene());
  plan.uncertainty = true;
  return plan;
}

}  // namespace pillarfield::viewer
