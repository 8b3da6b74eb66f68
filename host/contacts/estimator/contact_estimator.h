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

/// The estimator `contact` (docs/derivations/contact.md): a posterior over the friction of each
/// contact, carried over from frame to frame, and from it the normal forces of ambiguous pillars.
/// Runs after the direct solve on host threads; the bits do not depend on their number.
class ContactEstimator {
 public:
  explicit ContactEstimator(const SolverPlan& plan, std::size_t threads = 1,
                            const ContactParameters& parameters = {});

  /// Estimates the ambiguous pillars of the next frame, a direct solve of the plan.
  void resolve(ForceField& field);

  /// As above, for planes of the plan's size. Idle blocks are not read.
  void resolve(const FieldPlanes& field, const IdleBlocks& idle = {});

  /// The contacts of the last frame, and the friction of each.
  [[nodiscard]] const ContactLabels& contacts() const { return labels_; }
  [[nodiscard]] std::span<const ContactFriction> friction() const { return friction_.friction(); }

 private:
  void estimate(const FieldPlanes& field, std::uint32_t contact) const;

  ContactParameters parameters_;
  SegmentModel model_;
  FrictionEstimator friction_;
  std::uint32_t rows_;
  std::uint32_t cols_;
  ContactLabels labels_;
  std::unique_ptr<ThreadPool> pool_;
};

}  // namespace pillarfield
