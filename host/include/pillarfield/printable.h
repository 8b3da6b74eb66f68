#pragma once

#include <string>
#include <string_view>

namespace pillarfield {

/// Escapes untrusted text to one line that is safe on a terminal: control characters, characters
/// that change the writing direction ("\n", "\u001b"), and bytes that are not UTF-8 ("\xff"). The
/// text of an Error is already escaped.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace pillarfield
