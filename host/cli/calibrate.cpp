// pillarfield calibrate: from recordings of a skin to what its sensels do, step by step.

#include "cli/calibrate.h"

namespace pillarfield::cli {

void add_calibrate(CLI::App& app, Work& work) {
  CLI::App* const calibrate = app.add_subcommand(
      "calibrate", "Find out what the sensels of a skin do, step by step; see docs/calibration.md");
  calibrate->require_subcommand(1);
  add_calibrate_tare(*calibrate, work);
  add_calibrate_equilibrate(*calibrate, work);
  add_calibrate_load(*calibrate, work);
  add_calibrate_faults(*calibrate, work);
  add_calibrate_apply(*calibrate, work);
}

}  // namespace pillarfield::cli
