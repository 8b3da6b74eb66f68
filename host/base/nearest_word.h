#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace pillarfield {

/// Returns the candidate that begins with `word` or has the smallest optimal string alignment
/// distance; empty where that is above `most_edits`.
[[nodiscard]] std::string nearest_word(std::string_view word,
                                       const std::vector<std::string>& candidates,
                                       std::size_t most_edits);

/// Returns "; did you mean 'X'?" for the nearest word within a third of the word plus 1, if any.
[[nodiscard]] std::string suggestion(std::string_view word,
                                     const std::vector<std::string>& candidates);

}  // namespace pillarfield
