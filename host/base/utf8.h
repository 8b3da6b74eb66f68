#pragma once

#include <cstddef>
#include <string_view>

namespace pillarfield {

/// Length in bytes, 1 to 4, of the first character of `text`; 0 if it is not UTF-8 (RFC 3629) or
/// the text is empty.
[[nodiscard]] std::size_t utf8_length(std::string_view text);

/// Code point of one complete UTF-8 character.
[[nodiscard]] char32_t code_point(std::string_view character);

}  // namespace pillarfield
