#pragma once

#include <memory>

#include "pillarfield/processor.h"
#include "viewer/field/field_producer.h"
#include "viewer/field/frame_supply.h"

namespace pillarfield::viewer {

/// What a source asks of the solver, and what there is to show for it: angles always, uncertainty
/// where the noise is known and the estimator can tell.
[[nodiscard]] SolverPlan shown_plan(SolverPlan plan);

/// Solves the frames of a supply, each when it is asked for. A field lies where the processor wrote
/// it, and keeps the frame that it was solved from.
class SolvedProducer final : public FieldProducer {
 public:
  /// `processor` has kMostShown slots and is that of `supply`'s frames. Of `info` the number of
  /// frames is set here.
  SolvedProducer(SourceInfo info, std::unique_ptr<FrameSupply> supply, Processor processor);

  [[nodiscard]] const SourceInfo& info() const override { return info_; }
  [[nodiscard]] ShownField produce(std::uint64_t index) override;
  bool refresh() override;

 private:
  SourceInfo info_;
  std::unique_ptr<FrameSupply> supply_;
  Processor processor_;
};

}  // namespace pillarfield::viewer
