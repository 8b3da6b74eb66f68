#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace pillarfield::cli {

/// The script by which "bash", "zsh" or "fish" completes the commands of `app`.
[[nodiscard]] std::string completion_script(const CLI::App& app, const std::string& shell);

}  // namespace pillarfield::cli
