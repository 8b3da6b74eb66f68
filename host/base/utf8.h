#pragma once

#include <cstddef>
#include <string_view>

namespace pillarfield {

/// Bytes of the character that `text` begins with, 1 to 4; 0 where these are not UTF-8 (RFC 3629)
/// or the text is empty.
[[nodiscard]] std::size_t utf8_length(std::string_view text);

/// The code point of a character of UTF-8, whole as utf8_length() counts it.
[[nodiscard]] char32_t code_point(std::string_view character);

}  // namespace pillarfield
