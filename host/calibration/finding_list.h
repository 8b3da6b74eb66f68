#pragma once

#include <cstddef>
#include <vector>

#include "pillarfield/frame_statistics.h"
#include "pillarfield/sensel_finding.h"

namespace pillarfield {

/// The sensels that a step finds to be at fault, and the mask that follows from it.
class FindingList {
 public:
  /// `mask` is that of Calibration, so far; `statistics` tell what the sensels read.
  FindingList(std::vector<std::uint8_t> mask, const FrameStatistics& statistics);

  /// Whether the sensel is neither masked before nor found since.
  [[nodiscard]] bool good(std::size_t sensel) const { return mask_[sensel] != 0; }
  [[nodiscard]] std::size_t count_good() const;

  /// Notes the sensel, which from now on is not good.
  void mask(std::size_t sensel, SenselFault fault) { note(sensel, fault, true); }

  /// Notes the sensel, which stays good.
  void suspect(std::size_t sensel, SenselFault fault) { note(sensel, fault, false); }

  [[nodiscard]] const std::vector<SenselFinding>& findings() const { return findings_; }

  /// As Calibration::mask: empty where all are good.
  [[nodiscard]] std::vector<std::uint8_t> mask_plane() const;

 private:
  void note(std::size_t sensel, SenselFault fault, bool masked);

  const FrameStatistics& statistics_;
  std::vector<std::uint8_t> mask_;
  std::vector<SenselFinding> findings_;
};

}  // namespace pillarfield
