#pragma once

#include <string>
#include <string_view>

namespace pillarfield {

/// Throws Error, "file:line: ...", where a TOML text has a key of more than 16 parts, `a.b.c`
/// having three: toml++ goes into each part by recursion, without the bound that it has for values.
void check_key_depth(std::string_view toml, const std::string& file);

}  // namespace pillarfield
