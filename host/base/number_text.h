#pragma once

#include <cstdint>
#include <string>

/// Rounded numbers for text output.
namespace pillarfield {

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
