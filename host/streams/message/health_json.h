#pragma once

#include <nlohmann/json.hpp>

#include "pillarfield/live.h"

namespace pillarfield {

/// The counts and times of a report (docs/streams.md).
[[nodiscard]] nlohmann::ordered_json health_json(const HealthReport& health);

}  // namespace pillarfield
