// The status byte has one meaning: the public constants are the kernel's macros.

#include "pillarfield/status.h"

#include <gtest/gtest.h>

#include <array>

#include "kernels/pillar/status.h"

namespace pillarfield {
namespace {

struct Bit {
  const char* name;
  int in_public;
  int in_kernel;
};

constexpr std::array<Bit, 7> kBits = {{
    {"sensel 1", status::kSensel1, PF_STATUS_SENSEL_1},
    {"sensel 2", status::kSensel2, PF_STATUS_SENSEL_2},
    {"sensel 3", status::kSensel3, PF_STATUS_SENSEL_3},
    {"sensel 4", status::kSensel4, PF_STATUS_SENSEL_4},
    {"ambiguous", status::kAmbiguous, PF_STATUS_AMBIGUOUS},
    {"saturated", status::kSaturated, PF_STATUS_SATURATED},
    {"inconsistent", status::kInconsistent, PF_STATUS_INCONSISTENT},
}};

TEST(Status, PublicConstantsAreTheKernels) {
  for (const Bit& bit : kBits) EXPECT_EQ(bit.in_public, bit.in_kernel) << bit.name;
}

TEST(Status, EveryBitIsItsOwn) {
  int all = status::kFromNeighbours;
  for (const Bit& bit : kBits) {
    EXPECT_EQ(all & bit.in_kernel, 0) << bit.name;
    all |= bit.in_kernel;
  }
  EXPECT_EQ(all, 255);
}

TEST(Status, UsableIsTheFourSensels) {
  EXPECT_EQ(status::kUsable,
            PF_STATUS_SENSEL_1 | PF_STATUS_SENSEL_2 | PF_STATUS_SENSEL_3 | PF_STATUS_SENSEL_4);
}

}  // namespace
}  // namespace pillarfield
