#include "base/log_exp.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pillarfield {
namespace {

TEST(LogExp, AgreeWithTheLibraryOfC) {
  for (int i = -7000; i <= 7000; ++i) {
    const double x = 0.1 * i + 0.0137;
    const double exponential = std::exp(x);
    EXPECT_NEAR(fast_exp(x) / exponential, 1, 1e-12) << x;
    EXPECT_NEAR(fast_log(exponential), x, 1e-12 * std::abs(x)) << x;
  }
  EXPECT_EQ(fast_exp(0), 1);
  EXPECT_EQ(fast_log(1), 0);
}

}  // namespace
}  // namespace pillarfield
