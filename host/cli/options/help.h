#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>

namespace pillarfield::cli {

/// Returns the help of a command: usage, commands, arguments in groups, and the footer as examples.
/// Only lines of examples exceed 80 columns.
[[nodiscard]] std::string help_of(const CLI::App& app);

/// Returns a name such as "pillarfield calibrate tare".
[[nodiscard]] std::string full_name(const CLI::App& app);

/// Returns the completion script of "bash", "zsh" or "fish", which calls completion_words().
[[nodiscard]] std::string completion_script(const std::string& shell);

/// Returns the commands and options that may follow `words`, one "WORD<tab>DESCRIPTION" per line.
[[nodiscard]] std::string completion_words(const CLI::App& app, std::span<const std::string> words);

}  // namespace pillarfield::cli
