#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>

namespace pillarfield::cli {

/// As in scenes, whose numbers are those of TOML.
inline constexpr std::uint64_t kLargestSeed = std::numeric_limits<std::int64_t>::max();

/// Accepts a number in [least, most], neither NaN, which CLI::Range lets pass, nor infinite.
[[nodiscard]] CLI::Validator number_range(double least, double most);

/// Accepts a whole number in [least, most], written in decimal digits: CLI::Range takes "-1" for a
/// large number, one of too many digits for the largest, and "010" for eight.
[[nodiscard]] CLI::Validator whole_number_range(std::uint64_t least, std::uint64_t most);

}  // namespace pillarfield::cli
