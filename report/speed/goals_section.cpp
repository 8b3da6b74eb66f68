#include "report/speed/goals.h"
#include "report/speed/section.h"

namespace pillarfield::report {

std::string goals_section(const SpeedContext& context) {
  return "## Goals\n\nWhat was wanted before anything was measured, and what this run shows of "
         "it.\n\n" +
         goals_table(goals(context.run));
}

}  // namespace pillarfield::report
