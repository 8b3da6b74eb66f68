#pragma once

#include <filesystem>
#include <string>

namespace pillarfield::report {

/// Time of a way to solve a frame over that of the direct solve.
struct OverDirect {
  double time = 0;
  double processor = 0;  ///< of all threads together
};

/// What `Estimator::contact` costs on a device.
struct ContactCost {
  std::string device;
  double contact_share = 0;  ///< of the frame's pillars
  double open_share = 0;     ///< of the pillars in contact, those of region 3
  OverDirect contact;
  OverDirect tracked;  ///< and its contacts are followed by ContactTracker
};

/// A frame of a scene, solved in turns by each way and by the direct solve, 40 times; means of the
/// middle half of the times. Throws Error where the scene cannot be read.
[[nodiscard]] ContactCost measure_contact_cost(const std::filesystem::path& scene);

}  // namespace pillarfield::report
