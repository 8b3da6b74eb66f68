#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

/// Errors of the paper's printed equations, and of the corrected ones of
/// docs/derivations/pillar_model.md, section 6.
namespace pillarfield::errata {

/// Errors of an equation's angle over the directions to which it applies.
struct Deviation {
  int cases = 0;
  int wrong = 0;         ///< cases that are off by more than 0.01 rad, or not a number
  double worst_rad = 0;  ///< infinite where one is not a number
};

/// One equation, as it is printed and as it should be.
struct Erratum {
  std::string name;     ///< as a test is called
  std::string where;    ///< "(9), region 2.1"
  std::string printed;  ///< what the paper says
  std::function<Deviation()> measure_printed;
  std::string mended;  ///< what it should say
  std::function<Deviation()> measure_mended;
};

/// The errata of equations (5), (7), (8) and (9), for readings of the model rounded to double.
[[nodiscard]] std::vector<Erratum> equation_errata();

/// Equation (9) in regions 2.2 and 2.4, which is right as it is printed, up to the quadrant.
[[nodiscard]] std::array<Deviation, 2> right_as_printed();

/// The model's V of sensels 1 to 4, in units of F k, for what Table II calls Region 3.
[[nodiscard]] std::array<double, 4> table_two_region_three();

}  // namespace pillarfield::errata
