#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "pillarfield/frame.h"
#include "pillarfield/processor.h"
#include "viewer/source/field_producer.h"
#include "viewer/source/frame_provider.h"

namespace pillarfield::viewer {

/// Whether frames are estimated with the help of the frame before.
[[nodiscard]] bool remembers(Estimator estimator, const FrictionKnowledge& friction);

/// What a source asks of the solver, and what there is to show for it: angles always, uncertainty
/// where the noise is known and the estimator can tell.
[[nodiscard]] SolverPlan shown_plan(SolverPlan plan);

/// Solves the frames of a provider, each when it is asked for. A field lies where the processor
/// wrote it, and keeps the frame that it was solved from. Where the plan says that frames are
/// close, one that is asked for right after the frame before it knows of that, and any other of
/// none.
class SolvedProducer final : public FieldProducer {
 public:
  /// `processor` has kMostShown slots and is that of `plan`, which `provider`'s frames fit. Of
  /// `info` the number of frames is set here.
  SolvedProducer(SourceInfo info, std::unique_ptr<FrameProvider> provider, const SolverPlan& plan,
                 Processor processor);

  [[nodiscard]] const SourceInfo& info() const override { return info_; }
  [[nodiscard]] ShownField produce(std::uint64_t index) override;
  bool refresh() override;

 private:
  void clear_prior();

  SourceInfo info_;
  std::unique_ptr<FrameProvider> provider_;
  Processor processor_;
  std::optional<double> direct_point_;     ///< of the plan, where its estimator is direct
  std::optional<FrameBuffer> idle_frame_;  ///< a frame of it, where frames are close
  std::uint64_t next_ = 0;                 ///< the frame that would come after the last one solved
};

}  // namespace pillarfield::viewer
