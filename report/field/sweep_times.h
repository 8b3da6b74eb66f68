#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "report/field/field_run.h"

namespace pillarfield::report {

/// What solving a frame costs, over what the direct solve of it does.
struct OverDirect {
  double time = 0;
  double processor = 0;  ///< time of all threads together, which depends less on where they run
};

/// What the field estimator costs on a device.
struct SweepTimes {
  std::string device;
  double contact_share = 0;  ///< of the frame's pillars
  std::array<OverDirect, kSweeps.size()> over_direct{};
  OverDirect without_shape;  ///< of slip's evidence alone
  OverDirect square_metre;   ///< by default, of scenes/square_metre.toml; without contacts
  OverDirect square_metre_with_contacts;  ///< the same, contacts found and followed
  double square_metre_share = 0;          ///< of its pillars in contact
};

/// A frame of 16 contacts of different kinds, and one of a square metre, each solved in turns by
/// both, 40 times; means of the middle half of the times. Ten seconds. Throws Error where the scene
/// cannot be read.
[[nodiscard]] SweepTimes measure_sweep_times(const std::vector<field_study::Scene>& scenes,
                                             const std::filesystem::path& square_metre);

}  // namespace pillarfield::report
