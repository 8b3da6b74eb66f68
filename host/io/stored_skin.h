#pragma once

#include <optional>

#include "io/hdf5/file.h"
#include "pillarfield/calibration.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// The constants of a skin as /skin keeps them, in recordings and in calibration files; each may be
/// absent.
struct StoredSkin {
  std::optional<double> sensel_pitch_mm;
  std::optional<double> counts_per_newton;
  std::optional<double> threshold_counts;
  std::optional<double> full_scale_counts;
  std::optional<PowerLaw> power_law;
};

/// Makes the group /skin with the constants that there are, and returns it.
hdf5::Handle write_skin(const hdf5::File& file, const StoredSkin& skin);

/// What /skin holds; nothing where it is absent. Throws Error where one is no number, or half of a
/// power law is missing.
[[nodiscard]] StoredSkin read_skin(const hdf5::File& file);

/// The object /skin; invalid where it is absent.
[[nodiscard]] hdf5::Handle open_skin(const hdf5::File& file);

/// Makes the group /calibration with the planes that are not empty; none where all are.
void write_planes(const hdf5::File& file, const Skin& skin, const Calibration& calibration);

/// The planes that the file has, one value per sensel of `skin`, whose readings are of this type
/// where it is known. Throws Error where one is of another size or out of its range.
[[nodiscard]] Calibration read_planes(const hdf5::File& file, const Skin& skin,
                                      std::optional<SenselType> type = {});

}  // namespace pillarfield
