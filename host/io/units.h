#pragma once

#include <optional>
#include <string_view>

namespace pillarfield {

enum class Dimension { length, area, pressure, force, time };

/// Size of a unit by its name in a file, such as "cm²", "N/cm^2" or "msec", in any case: in mm,
/// mm², MPa, N or s; unset if the name is none of this dimension.
[[nodiscard]] std::optional<double> unit_size(Dimension dimension, std::string_view name);

}  // namespace pillarfield
