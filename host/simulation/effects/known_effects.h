#pragma once

#include "pillarfield/scene.h"
#include "pillarfield/sensor_effects.h"

namespace pillarfield {

/// Counts of a reading at full scale; 255 for a sensor without one.
[[nodiscard]] double full_scale_or_255(const Skin& skin);

/// The effects of a sensor that SensorEffects describes exactly: all but hysteresis and creep.
[[nodiscard]] SensorEffects known_effects(const SensorModel& sensor, const Skin& skin);

}  // namespace pillarfield
