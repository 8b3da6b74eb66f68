#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "pillarfield/force_parts.h"

namespace pillarfield::cli {

/// The parts that this process solves.
struct PartShare {
  std::uint64_t count = 0;             ///< of all processes
  std::vector<std::uint64_t> indices;  ///< from 1
};

/// The share that the options name: one part, or all of them; nothing without --part and --parts.
[[nodiscard]] std::optional<PartShare> share_of(const PartOptions& options);

/// The checkpoints of the options: by default a tenth of the distance is warm-up.
[[nodiscard]] Checkpoints checkpoints_of(const PartOptions& options);

/// Whether `text` has the form K/N.
[[nodiscard]] bool is_part(const std::string& text);

}  // namespace pillarfield::cli
