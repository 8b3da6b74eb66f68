#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pillarfield {

/// Returns the candidate that begins with `word` or has the smallest optimal string alignment
/// distance; empty where that is at least a third of the word plus 2.
[[nodiscard]] std::string nearest_word(std::string_view word,
                                       const std::vector<std::string>& candidates);

/// Returns "; did you mean 'X'?" for the nearest word, if any.
[[nodiscard]] std::string suggestion(std::string_view word,
                                     const std::vector<std::string>& candidates);

}  // namespace pillarfield
