// Hard cases by name: the error of the arithmetic beside the condition of the problem.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include "report/section.h"
#include "report/table.h"
#include "tests/kernels/case_accuracy.h"

namespace pillarfield::report {
namespace {

using hard_cases::Example;
using hard_cases::HardCase;
using hard_cases::Precision;

constexpr const char* kIntroduction = R"(## Hard cases

How exact is the arithmetic? Each case stands for up to 192 pillars; the errors are the worst of them: of a component
of the force, against the exact answer for the very readings given, in units of ε|F|, with ε = 1.2e-7 for float and
2.2e-16 for double. κ is the condition number of the map from readings to force, the largest factor by which it magnifies a
relative error of the readings; an error of about κ is all that can be asked for. Both are defined in
[conditioning.md](derivations/conditioning.md), as are the bounds that the tests hold: 3 for `direct`, 42 + κ/2 for `paper`. The third
κ is of `paper` with sensels 1 and 3 in equation (5), as the paper assigns them in region 1.

)";

constexpr const char* kEnd = R"(
No case is hard for the direct solve: its worst error is {direct:.2f} ε|F|. The paper's equations are 0/0 where all usable readings are equal,
and with sensels 1 and 3 in region 1 wherever these two are. With sensels chosen by the direction of the shear ([P1,
P2](derivations/paper_solve.md)) their worst error is {paper:.2f} ε|F|: what they lack is not exactness but, in region 1, economy with noise. Subnormal results are measured in the spacing of subnormal numbers. No output was
infinite or not a number, whatever the readings; where a reading is, the status says that a sensel is missing.
)";

/// The larger one; not a number wins.
double worse(double a, double b) { return std::isnan(a) || a > b ? a : b; }

double worst_condition(const HardCase& hard_case, Estimator estimator) {
  double worst = 0;
  for (const Example& example : hard_case.examples(Precision::double_precision)) {
    worst = worse(worst, condition_of(example, estimator, Precision::double_precision));
  }
  return worst;
}

double worst_condition_as_assigned(const HardCase& hard_case) {
  double worst = 0;
  for (const Example& example : hard_case.examples(Precision::double_precision)) {
    worst = worse(worst, condition_as_assigned(example, Precision::double_precision));
  }
  return worst;
}

double worst_error(const HardCase& hard_case, Estimator estimator, Precision precision) {
  double worst = 0;
  for (const Example& example : hard_case.examples(precision)) {
    const auto outcome = solve(example, estimator, precision);
    worst = worse(worst, error_of(outcome, example, estimator, precision));
  }
  return worst;
}

std::string condition_text(double condition) {
  constexpr double kUnbounded = 1e6;
  if (std::isnan(condition)) return "0/0";
  return condition > kUnbounded ? "∞" : fmt::format("{:.2f}", condition);
}

}  // namespace

std::string hard_cases_section(const Context& /*context*/) {
  Table table("lrrrrrrr", {"Case", "κ direct", "κ paper", "κ paper, 1 and 3", "direct float",
                           "direct double", "paper float", "paper double"});
  std::array<double, 2> worst{};
  for (const HardCase& hard_case : hard_cases::hard_cases()) {
    std::vector<std::string> cells = {hard_case.what,
                                      condition_text(worst_condition(hard_case, Estimator::direct)),
                                      condition_text(worst_condition(hard_case, Estimator::paper)),
                                      condition_text(worst_condition_as_assigned(hard_case))};
    for (const Estimator estimator : {Estimator::direct, Estimator::paper}) {
      for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
        const double error = worst_error(hard_case, estimator, precision);
        double& most = worst.at(static_cast<std::size_t>(estimator));
        most = std::max(most, error);
        cells.push_back(fmt::format("{:.2f}", error));
      }
    }
    table.add(cells);
  }
  return kIntroduction + table.text() +
         fmt::format(kEnd, fmt::arg("direct", worst[0]), fmt::arg("paper", worst[1]));
}

}  // namespace pillarfield::report
