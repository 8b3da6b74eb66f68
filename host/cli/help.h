#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace pillarfield::cli {

/// The help of a command: usage, arguments in groups, its commands, and the footer as examples.
/// No line is longer than 80 columns but those of examples.
[[nodiscard]] std::string help_of(const CLI::App& app);

/// "pillarfield calibrate tare".
[[nodiscard]] std::string full_name(const CLI::App& app);

}  // namespace pillarfield::cli
