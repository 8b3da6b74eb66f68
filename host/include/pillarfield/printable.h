#pragma once

#include <string>
#include <string_view>

namespace pillarfield {

/// Text from outside as one line that is safe to print on a terminal: control characters and those
/// that change the direction of writing are escaped ("\n", "\u001b"), as are bytes that are
/// not UTF-8 ("\xff"). The text of an Error already is.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace pillarfield
