#pragma once

#include <nlohmann/json.hpp>

#include "pillarfield/doctor.h"

namespace pillarfield {

/// A diagnosis as `pillarfield doctor --json` prints it, for the command and the Python package.
[[nodiscard]] nlohmann::ordered_json facts_of(const Diagnosis& found);

}  // namespace pillarfield
