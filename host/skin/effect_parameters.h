#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/range.h"
#include "pillarfield/sensor_effects.h"

namespace pillarfield {

/// A parameter of SensorEffects under its name in files (docs/formats.md): one number or a list.
struct EffectParameter {
  const char* effect;  ///< the effect's name in Python
  const char* name;
  Range range;  ///< of each value
  std::vector<double> values = {};
  bool list = false;
};

/// The parameters of the effects that are set.
[[nodiscard]] std::vector<EffectParameter> parameters_of(const SensorEffects& effects);

/// Returns the values of a parameter, unset for an absent one.
using FindParameter = std::function<std::optional<std::vector<double>>(const EffectParameter&)>;

/// The effects whose parameters `find` returns. Throws Error, naming `where`, if a number is a
/// list, or if only some parameters of an effect are there and `all_needed`; else these keep their
/// values without an effect. Ranges are left to check().
[[nodiscard]] SensorEffects effects_of(const FindParameter& find, std::string_view where,
                                       bool all_needed = true);

}  // namespace pillarfield
