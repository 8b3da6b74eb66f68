#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pillarfield/read_options.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// Constants of a skin that a recording, a calibration or a sensor states; each may be absent.
struct StoredSkin {
  std::optional<Pitch> sensel_pitch_mm = {};
  std::optional<double> counts_per_newton = {};
  std::optional<double> threshold_counts = {};
  std::optional<double> full_scale_counts = {};
  std::optional<PowerLaw> power_law = {};
  std::optional<SkinLayout> layout = {};
  bool falling = false;  ///< readings fell under load, and are mirrored
};

/// Sets the constants of a skin to those of the options, else to those that are stated; the others
/// stay, but the layout: without a word each sensel is by itself.
void take_constants(Skin& skin, const StoredSkin& stated, const ReadOptions& options);

/// The options about files of frames, which a live source has no use for, and are set.
[[nodiscard]] std::vector<std::string> given_file_options(const ReadOptions& options);

}  // namespace pillarfield
