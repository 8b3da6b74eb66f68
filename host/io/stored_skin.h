#pragma once

#include <optional>

#include "io/hdf5/file.h"
#include "io/skin_constants.h"
#include "pillarfield/calibration.h"
#include "pillarfield/skin.h"
#include "pillarfield/surface.h"

namespace pillarfield {

/// Creates the group /skin with the constants that are set, and returns it.
hdf5::Handle write_skin(const hdf5::File& file, const StoredSkin& skin);

/// Reads /skin; all constants are unset if it is absent. Throws Error if one is not a number or one
/// of the two power-law constants is missing.
[[nodiscard]] StoredSkin read_skin(const hdf5::File& file);

/// Writes a pitch as one number, or as two: from row to row, from column to column.
void write_pitch(const hdf5::File& file, hid_t object, const char* name, const Pitch& pitch);

/// Reads such a pitch; unset if it is absent. Throws Error if it has neither one nor two numbers.
[[nodiscard]] std::optional<Pitch> read_pitch(const hdf5::File& file, hid_t object,
                                              const char* name);

/// The object /skin; invalid if absent.
[[nodiscard]] hdf5::Handle open_skin(const hdf5::File& file);

/// Creates the group `place` with the parameters of the effects, unless there are none.
void write_effects(const hdf5::File& file, const char* place, const SensorEffects& effects);

/// Reads the effects in the group `place`; none if it is absent. Throws Error if one is incomplete.
[[nodiscard]] SensorEffects read_effects(const hdf5::File& file, const char* place);

/// Creates the group /calibration with the non-empty planes, and its group /calibration/effects if
/// there are any; no group if the calibration is empty.
void write_planes(const hdf5::File& file, const Skin& skin, const Calibration& calibration);

/// Replaces the threshold in /skin and the planes tare and noise that the file has.
void rewrite_tare(const hdf5::File& file, const Calibration& calibration, double threshold_counts);

/// Reads the planes and effects in the file, one value per sensel of `skin`; `type` is that of its
/// readings, unset if unknown. Throws Error if a plane has another size or a value is out of range.
[[nodiscard]] Calibration read_planes(const hdf5::File& file, const Skin& skin,
                                      std::optional<SenselType> type = {});

/// Creates the group /surface of recordings and force files: shape, radius, axis, heights.
void write_surface(const hdf5::File& file, const Surface& surface, const ElementGrid& pillars);

/// Reads the group /surface; unset if it is absent. Throws Error if it does not fit the pillars.
[[nodiscard]] std::optional<Surface> read_surface(const hdf5::File& file,
                                                  const ElementGrid& pillars);

}  // namespace pillarfield
