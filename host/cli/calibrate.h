#pragma once

#include "cli/command.h"

namespace pillarfield::cli {

// Each adds one step to `pillarfield calibrate`.
void add_calibrate_tare(CLI::App& calibrate, Work& work);
void add_calibrate_equilibrate(CLI::App& calibrate, Work& work);
void add_calibrate_load(CLI::App& calibrate, Work& work);
void add_calibrate_faults(CLI::App& calibrate, Work& work);
void add_calibrate_apply(CLI::App& calibrate, Work& work);

}  // namespace pillarfield::cli
