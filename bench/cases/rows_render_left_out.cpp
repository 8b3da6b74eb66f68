// In place of rows_render.cpp where the viewer is not built.

#include <fmt/format.h>

#include "bench/cases/rows.h"
#include "bench/timing/measurement.h"
#include "bench/timing/plain_names.h"
#include "pillarfield/error.h"

namespace pillarfield::bench {

void add_render_rows(const Session& /*session*/) {
  add_row("render", []() -> Measurement {
    throw Error("", fmt::format("{}the viewer was not built", kSkipped),
                "configure with PILLARFIELD_VIEWER=ON");
  });
}

}  // namespace pillarfield::bench
