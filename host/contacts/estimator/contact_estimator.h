#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "base/thread_pool.h"
#include "contacts/estimator/contact_parameters.h"
#include "contacts/estimator/field_planes.h"
#include "contacts/estimator/friction_estimator.h"
#include "pillarfield/contact_labels.h"
#include "pillarfield/force_field.h"
#include "pillarfield/solver_plan.h"
#include "solve/idle_blocks.h"

namespace pillarfield {

/// The estimator `contact`: for each contact a posterior over its friction, carried from frame to
/// frame, and from it the normal forces of the pillars that readings leave ambiguous
/// (docs/derivations/contact.md). It runs on the host's threads, after the direct solve, and gives
/// the same bits with any number of them.
class ContactEstimator {
 public:
  explicit ContactEstimator(const SolverPlan& plan, std::size_t threads = 1,
                            const ContactParameters& parameters = {});

  /// Estimates the ambiguous pillars of the next frame, which the direct solve of the plan left.
  void resolve(ForceField& field);

  /// The same of planes of the plan's size. Of idle blocks nothing is read.
  void resolve(const FieldPlanes& field, const IdleBlocks& idle = {});

  /// The contacts of the last frame, and what is believed of each.
  [[nodiscard]] const ContactLabels& contacts() const { return map_; }
  [[nodiscard]] std::span<const ContactFriction> friction() const { return friction_.friction(); }

 private:
  struct Batch;

  void estimate(const FieldPlanes& field, std::uint32_t contact) const;
  void write(const FieldPlanes& field, const ContactModel& model, const Batch& batch,
             std::size_t i) const;

  ContactParameters parameters_;
  SegmentEnd end_;
  FrictionEstimator friction_;
  std::uint32_t rows_;
  std::uint32_t cols_;
  ContactLabels map_;
  std::unique_ptr<ThreadPool> team_;
};

}  // namespace pillarfield
