#pragma once

#include <optional>

#include "io/hdf5/attribute.h"
#include "io/skin_constants.h"
#include "pillarfield/calibration.h"
#include "pillarfield/skin.h"
#include "pillarfield/skin_calibration.h"
#include "pillarfield/surface.h"

namespace pillarfield {

inline constexpr const char* kSkinGroup = "/skin";

/// Creates the group /skin with the constants that are set, and returns it: those of a Skin or of a
/// SkinCalibration.
template <class Constants>
hdf5::Handle write_skin(const hdf5::File& file, const Constants& skin);

/// Reads the constants in /skin into a StoredSkin or a SkinCalibration; those that are absent are
/// unset. Throws Error if one is not a number or one of the two power-law constants is missing.
template <class Constants>
void read_skin(const hdf5::File& file, Constants& skin);

/// Reads the attribute `layout` of an object; unset if it is absent.
[[nodiscard]] std::optional<SkinLayout> read_layout(const hdf5::Attributes& attributes,
                                                    const hdf5::File& file);

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
