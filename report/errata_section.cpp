// The errata of the paper, with the numbers that their tests show.

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "report/section.h"
#include "report/table.h"
#include "tests/kernels/errata.h"

namespace pillarfield::report {
namespace {

using errata::Deviation;

constexpr const char* kIntroduction = R"(## Errata of the paper

Each equation, as it is printed and as [pillar_model.md](derivations/pillar_model.md) mends it, is given readings of the model
from directions spread over the region where it applies. *Wrong* counts the directions that come out more
than 0.01 rad off; tangents are compared up to half a turn, `atan2` up to a whole one.
`tests/kernels/errata_test.cpp` holds both: the printed form fails, the mended one passes.

)";

std::string wrong(const Deviation& deviation) {
  return fmt::format("{} of {}", deviation.wrong, deviation.cases);
}

std::string worst(const Deviation& deviation) {
  if (std::isinf(deviation.worst_rad)) return "0/0";
  if (deviation.worst_rad == 0) return "0";
  const bool small = deviation.worst_rad < 0.001;
  return small ? fmt::format("{:.0e}", deviation.worst_rad)
               : fmt::format("{:.2f}", deviation.worst_rad);
}

std::string table_two() {
  const auto v = errata::table_two_region_three();
  return fmt::format(
      R"(
Equation (9) is right as printed in regions 2.2 and 2.4, up to the quadrant: worst {} and {} rad.

Table II takes φ = 5.760, θ = 1.222 for region 3. The model's readings there are V1 to V4 = {:.3f}, {:.3f}, {:.3f}
and {:.3f} F k: only sensel 4 is lifted, which is region 2.4. Sensel 1 is pressed so little that a dead zone of
{:.3f} F k hides it.
)",
      worst(errata::right_as_printed()[0]), worst(errata::right_as_printed()[1]), v[0], v[1], v[2],
      v[3], v[0]);
}

}  // namespace

std::string errata_section(const Context& /*context*/) {
  Table table("llrrlrr",
              {"Equation", "printed", "wrong", "worst, rad", "mended", "wrong", "worst, rad"});
  for (const errata::Erratum& erratum : errata::equation_errata()) {
    const Deviation printed = erratum.measure_printed();
    const Deviation mended = erratum.measure_mended();
    table.add({erratum.where, erratum.printed, wrong(printed), worst(printed), erratum.mended,
               wrong(mended), worst(mended)});
  }
  return kIntroduction + table.text() + table_two();
}

}  // namespace pillarfield::report
