#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <span>

#include "pillarfield/force_field.h"

namespace pillarfield {

/// Expects planes that agree bit for bit.
inline void expect_same_bits(std::span<const float> actual, std::span<const float> expected,
                             const char* plane) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i) {
    ASSERT_EQ(std::bit_cast<std::uint32_t>(actual[i]), std::bit_cast<std::uint32_t>(expected[i]))
        << plane << " of pillar " << i << ": " << actual[i] << " is not " << expected[i];
  }
}

/// Expects forces and status that agree bit for bit.
inline void expect_same_bits(const ForceFieldView& actual, const ForceFieldView& expected) {
  ASSERT_EQ(actual.rows, expected.rows);
  ASSERT_EQ(actual.cols, expected.cols);
  expect_same_bits(actual.shear_x, expected.shear_x, "shear_x");
  expect_same_bits(actual.shear_y, expected.shear_y, "shear_y");
  expect_same_bits(actual.normal, expected.normal, "normal");
  for (std::size_t i = 0; i < actual.status.size(); ++i) {
    ASSERT_EQ(actual.status[i], expected.status[i]) << "status of pillar " << i;
  }
}

}  // namespace pillarfield
