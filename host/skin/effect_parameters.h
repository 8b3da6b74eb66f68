#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pillarfield/sensor_effects.h"

namespace pillarfield {

/// A parameter of SensorEffects under its name in files (docs/formats.md): one number or a list.
struct EffectParameter {
  const char* name;
  std::vector<double> values;
  bool list = false;
};

/// The parameters of the effects that are set.
[[nodiscard]] std::vector<EffectParameter> parameters_of(const SensorEffects& effects);

/// The effects whose parameters `find` returns; it returns an unset value for an absent one. Throws
/// Error, naming `where`, if only some parameters of an effect are there or a number is a list.
[[nodiscard]] SensorEffects effects_of(
    const std::function<std::optional<std::vector<double>>(const char* name)>& find,
    std::string_view where);

}  // namespace pillarfield
