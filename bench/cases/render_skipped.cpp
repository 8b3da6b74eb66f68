// Replaces render.cpp where the viewer is not built.

#include <fmt/format.h>

#include "bench/cases/cases.h"
#include "bench/timing/measurement.h"
#include "bench/timing/unsuffixed_reporter.h"
#include "pillarfield/error.h"

namespace pillarfield::bench {

void add_render_cases(const Session& /*session*/) {
  add_case("render", []() -> Measurement {
    throw Error("", fmt::format("{}the viewer was not built", kSkipped),
                "configure with PILLARFIELD_VIEWER=ON");
  });
}

}  // namespace pillarfield::bench
