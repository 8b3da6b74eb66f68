#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "calibration/doctor/response_watch.h"
#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// Notices rows and columns of a solved recording that do not respond and are not masked: contacts
/// over them are cut, and lack force.
class LineCheck {
 public:
  /// `plan` must outlive the check. Judges plans with a tare or a threshold.
  explicit LineCheck(const SolverPlan& plan);

  /// Looks at a frame in which something touches; of long recordings at one of 64.
  void add(const FrameView& readings);

  [[nodiscard]] std::vector<std::string> warnings() const;

 private:
  const SolverPlan& plan_;
  ResponseWatch watch_;
  std::vector<float> signals_;
  std::vector<float> least_;
  std::uint64_t frames_ = 0;
};

}  // namespace pillarfield
