#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "cli/commands.h"
#include "pillarfield/force_parts.h"

namespace pillarfield::cli {

/// K and N of "K/N", where 1 <= K <= N <= kMostParts; unset for other texts.
[[nodiscard]] std::optional<std::pair<std::uint64_t, std::uint64_t>> part_of(
    const std::string& text);

/// The checkpoints of the options: by default a tenth of the distance is warm-up.
[[nodiscard]] Checkpoints checkpoints_of(const PartOptions& options);

}  // namespace pillarfield::cli
