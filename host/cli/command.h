#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace pillarfield::cli {

/// What main() runs once the command line is understood; throws Error where the work fails.
using Work = std::function<void()>;

// Each adds its subcommand to `app`; when it is the one called, `work` becomes what it does.
void add_simulate(CLI::App& app, Work& work);
void add_solve(CLI::App& app, Work& work);
void add_live(CLI::App& app, Work& work);
void add_compare(CLI::App& app, Work& work);
void add_calibrate(CLI::App& app, Work& work);
void add_testbed(CLI::App& app, Work& work);
void add_info(CLI::App& app, Work& work);
void add_completion(CLI::App& app, Work& work);

}  // namespace pillarfield::cli
