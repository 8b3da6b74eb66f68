#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "tests/kernels/one_pillar.h"
#include "tests/kernels/oracle.h"

/// Named hard cases of single pillars, for tests and docs/derivations/conditioning.md.
namespace pillarfield::hard_cases {

/// Precision of the arithmetic and of the rounded readings.
enum class Precision { single_precision, double_precision };

/// A pillar to solve.
struct Example {
  std::array<double, 4> raw{};  ///< counts, sensels 1 to 4; numbers of the precision asked for
  PillarSensor sensor;
};

struct HardCase {
  std::string name;  ///< as a test is called: letters, digits and underscores
  std::string what;  ///< description
  int status = 0;    ///< bits beside the usable ones that every example must have
  std::function<std::vector<Example>(Precision)> examples;
};

/// All of them; some 1,500 examples.
[[nodiscard]] const std::vector<HardCase>& hard_cases();

/// `exact` as the nearest number of a precision.
[[nodiscard]] double rounded(oracle::Exact exact, Precision precision);

}  // namespace pillarfield::hard_cases
