#pragma once

#include <string>
#include <string_view>

namespace pillarfield {

/// A text, as that of a file, as one line that a terminal can show and that cannot command it:
/// control characters and such as turn the direction of writing are escaped, "\n" and "\u001b", and
/// so are bytes that are not UTF-8, "\xff". The text of an Error is such a line already.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace pillarfield
