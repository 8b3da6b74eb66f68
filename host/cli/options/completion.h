#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>

namespace pillarfield::cli {

/// Returns the completion script of "bash", "zsh" or "fish", which calls completion_words().
[[nodiscard]] std::string completion_script(const std::string& shell);

/// Returns the commands and options that may follow `words`, one "WORD<tab>DESCRIPTION" per line.
[[nodiscard]] std::string completion_words(const CLI::App& app, std::span<const std::string> words);

}  // namespace pillarfield::cli
