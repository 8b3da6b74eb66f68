#pragma once

#include <cstdint>
#include <string>

/// Numbers for people. JSON has them whole.
namespace pillarfield::cli {

/// "1,234,567".
[[nodiscard]] std::string grouped(std::uint64_t number);

/// "1 frame", "1,200 frames".
[[nodiscard]] std::string counted(std::uint64_t number, const char* noun);

/// Five significant digits, all those before the point, an exponent for the tiniest only:
/// "0.63246", "12,346".
[[nodiscard]] std::string rounded(double number);

/// "25.0 %"; "<0.1 %" of a part that would vanish.
[[nodiscard]] std::string percent(std::uint64_t part, std::uint64_t whole);

}  // namespace pillarfield::cli
