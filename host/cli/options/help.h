#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace pillarfield::cli {

/// Returns the help of a command: usage, commands, arguments in groups, and the footer as examples.
/// Only lines of examples exceed 80 columns.
[[nodiscard]] std::string help_of(const CLI::App& app);

/// Returns a name such as "pillarfield calibrate tare".
[[nodiscard]] std::string full_name(const CLI::App& app);

}  // namespace pillarfield::cli
