#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pillarfield/error.h"

namespace pillarfield {

/// Words of messages, and those that stand for them in a front end: `noise_counts`, `--noise`.
using Rewording = std::vector<std::pair<std::string, std::string>>;

/// The text with each whole word replaced.
[[nodiscard]] std::string reworded(std::string_view text, const Rewording& words);

/// The error with the words of its remedy replaced; a remedy that has words for Python stays.
[[nodiscard]] Error reworded(const Error& error, const Rewording& words);

}  // namespace pillarfield
