#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pillarfield {

/// Returns "; did you mean 'X'?" for the nearest word within a third of the word plus 1, if any.
[[nodiscard]] std::string suggestion(std::string_view word,
                                     const std::vector<std::string>& candidates);

}  // namespace pillarfield
