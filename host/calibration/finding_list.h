#pragma once

#include <cstddef>
#include <vector>

#include "pillarfield/calibration.h"
#include "pillarfield/frame_statistics.h"
#include "pillarfield/sensel_finding.h"

namespace pillarfield {

/// The sensels that a calibration step finds faulty, and the resulting mask.
class FindingList {
 public:
  /// `mask` is Calibration::mask before the step; `statistics` are those of the step's frames.
  FindingList(std::vector<std::uint8_t> mask, const FrameStatistics& statistics);

  /// True if the sensel is masked neither before nor by the step.
  [[nodiscard]] bool good(std::size_t sensel) const { return mask_[sensel] == kGood; }
  [[nodiscard]] std::size_t count_good() const;

  /// Adds a finding and masks the sensel.
  void mask(std::size_t sensel, SenselFault fault) { note(sensel, fault, true); }

  /// Adds a finding without masking the sensel.
  void suspect(std::size_t sensel, SenselFault fault) { note(sensel, fault, false); }

  [[nodiscard]] const std::vector<SenselFinding>& findings() const { return findings_; }

  /// The mask as in Calibration::mask: empty if all sensels are good.
  [[nodiscard]] std::vector<std::uint8_t> mask_plane() const;

 private:
  void note(std::size_t sensel, SenselFault fault, bool masked);

  const FrameStatistics& statistics_;
  std::vector<std::uint8_t> mask_;
  std::vector<SenselFinding> findings_;
};

}  // namespace pillarfield
