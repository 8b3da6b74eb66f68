#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>

namespace pillarfield::cli {

/// The script by which "bash", "zsh" or "fish" asks the command for the words that may come next.
[[nodiscard]] std::string completion_script(const std::string& shell);

/// The commands and options that may come after `words`, a line each: the word, a tab, what it is.
[[nodiscard]] std::string completion_words(const CLI::App& app, std::span<const std::string> words);

}  // namespace pillarfield::cli
