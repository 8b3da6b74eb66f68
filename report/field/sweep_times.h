#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "report/field/field_run.h"

namespace pillarfield::report {

/// How long the field estimator takes on a device, beside the direct solve of the same frame.
struct SweepTimes {
  std::string device;
  double contact_share = 0;                          ///< of the frame's pillars
  std::array<double, kSweeps.size()> over_direct{};  ///< time over that of `direct`; 0: not solved
  double without_shape = 0;                          ///< the same, of slip's evidence alone
  double square_metre = 0;  ///< by default, of scenes/square_metre.toml; without contacts
  double square_metre_with_contacts = 0;  ///< the same, contacts found and followed
  double square_metre_share = 0;          ///< of its pillars in contact
};

/// A frame of 16 contacts of different kinds, and one of a square metre, each solved in turns by
/// both, 40 times; means of the middle half of the times. Ten seconds. Throws Error where the scene
/// cannot be read.
[[nodiscard]] SweepTimes measure_sweep_times(const std::vector<field_study::Scene>& scenes,
                                             const std::filesystem::path& square_metre);

}  // namespace pillarfield::report
