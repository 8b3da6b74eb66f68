#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "pillarfield/force_parts.h"
#include "pillarfield/processor.h"
#include "pillarfield/recording.h"

namespace pillarfield {

/// Follows the baseline through a few frames of each checkpoint's distance, so that the tare at a
/// checkpoint has the drift of all frames before it. The result depends on the checkpoints alone.
class BaselineSurvey {
 public:
  /// The plan must follow the baseline, on a skin that is not bent.
  BaselineSurvey(FrameSource& source, const Device& device, const SolverPlan& plan,
                 const Checkpoints& checkpoints);

  /// The tare at a frame, not before that of the last call, [sensel rows, cols], counts; of an
  /// earlier one once `stop` returns true.
  [[nodiscard]] std::vector<float> tare_at(std::uint64_t frame, const std::function<bool()>& stop);

 private:
  FrameSource& source_;
  std::uint64_t step_;
  std::uint64_t next_ = 0;
  FrameBuffer frame_;
  Processor processor_;
};

}  // namespace pillarfield
