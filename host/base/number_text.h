#pragma once

#include <cstdint>
#include <string>

/// Numbers in text output; those for people are rounded.
namespace pillarfield {

/// A number of JSON that readers with types take for floating point, "0.0", or null.
[[nodiscard]] std::string json_number(double number);

/// "1,234,567".
[[nodiscard]] std::string grouped(std::uint64_t number);

/// "1 frame", "1,200 frames".
[[nodiscard]] std::string counted(std::uint64_t number, const char* noun);

/// Five significant digits, and all digits before the point: "0.63246", "12,346".
[[nodiscard]] std::string rounded(double number);

/// As "{:.1f}" with this many decimals, but "0.0" in place of "-0.0".
[[nodiscard]] std::string fixed(double number, int decimals);

/// "25.0 %"; "<0.1 %" of a part that would round to zero.
[[nodiscard]] std::string percent(std::uint64_t part, std::uint64_t whole);

}  // namespace pillarfield
