#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pillarfield::cli {

/// The candidate with the fewest edits from `word` (a letter inserted, deleted or replaced, or two
/// neighbours exchanged), or that begins with it; empty where even that takes too many.
[[nodiscard]] std::string nearest_word(std::string_view word,
                                       const std::vector<std::string>& candidates);

/// "; did you mean 'X'?" for the nearest candidate; empty where there is none.
[[nodiscard]] std::string suggestion(std::string_view word,
                                     const std::vector<std::string>& candidates);

}  // namespace pillarfield::cli
