// The paper's printed equations have the errors that docs/derivations/pillar_model.md lists, and
// its corrections are right.

#include "lab/studies/errata.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>

namespace pillarfield::errata {
namespace {

class Errata : public testing::TestWithParam<Erratum> {};

TEST_P(Errata, ThePrintedEquationIsWrong) {
  const Deviation printed = GetParam().measure_printed();
  // A tangent of the wrong sign is right where it vanishes.
  EXPECT_GE(printed.wrong, 0.95 * printed.cases);
  EXPECT_GT(printed.worst_rad, 0.3);
}

TEST_P(Errata, TheCorrectedEquationIsRight) {
  const Deviation mended = GetParam().measure_mended();
  EXPECT_GT(mended.cases, 0);
  EXPECT_EQ(mended.wrong, 0);
  EXPECT_LT(mended.worst_rad, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(In, Errata, testing::ValuesIn(equation_errata()),
                         [](const testing::TestParamInfo<Erratum>& erratum) {
                           return erratum.param.name;
                         });

TEST(NoErrata, EquationNineIsRightInRegionsTwoAndFour) {
  for (const Deviation& deviation : right_as_printed()) {
    EXPECT_GT(deviation.cases, 30);
    EXPECT_LT(deviation.worst_rad, 1e-9);
  }
}

TEST(TableTwo, ItsRegionThreeIsRegionTwoOfTheModel) {
  const std::array<double, 4> v = table_two_region_three();
  EXPECT_LT(v[3], 0);
  for (std::size_t n = 0; n < 3; ++n) EXPECT_GT(v[n], 0);
  EXPECT_NEAR(v[0], 0.098, 0.0005);
}

}  // namespace
}  // namespace pillarfield::errata
