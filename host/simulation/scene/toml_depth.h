#pragma once

#include <string>
#include <string_view>

namespace pillarfield {

/// Throws Error, "file:line: ...", if a TOML text has a key of more than 16 parts (`a.b.c` has
/// three): toml++ recurses into each part without a bound.
void check_key_depth(std::string_view toml, const std::string& file);

}  // namespace pillarfield
