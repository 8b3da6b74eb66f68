#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pillarfield::cli {

/// "; did you mean 'X'?" for the candidate that begins with `word`, or that is made of it by the
/// fewest edits: a letter inserted, deleted or replaced, or two neighbours exchanged. Empty where
/// even that takes too many.
[[nodiscard]] std::string suggestion(std::string_view word,
                                     const std::vector<std::string>& candidates);

}  // namespace pillarfield::cli
