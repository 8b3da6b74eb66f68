#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "contacts/contact_matching.h"
#include "contacts/estimator/contact_parameters.h"
#include "contacts/estimator/contact_samples.h"
#include "contacts/estimator/friction_belief.h"
#include "contacts/estimator/friction_evidence.h"
#include "contacts/estimator/pressure_regression.h"
#include "pillarfield/contact_labels.h"
#include "pillarfield/force_field.h"
#include "pillarfield/friction.h"

namespace pillarfield {

/// What the ambiguous pillars of a contact are estimated with.
struct ContactModel {
  static constexpr std::size_t kNodes = 6;

  /// A normal force, N, and its variance, N².
  struct Estimate {
    double normal;
    double variance;
  };

  ContactBox box;
  std::array<float, kNodes> frictions{};  ///< of equal probability
  std::optional<PressureRegression> pressure;
  double noise_n = 0;
  bool any_ambiguous = false;  ///< or may be

  /// What the regression of the pressure predicts of a pillar (C6); no more than the end `high` of
  /// its segment, N.
  [[nodiscard]] std::optional<Estimate> predicted(std::uint32_t row, std::uint32_t col, double high,
                                                  const ContactParameters& parameters) const;
};

/// Learns the friction of each contact from frame to frame: a posterior over the coefficient,
/// carried by the contact's identity (docs/derivations/contact.md, sections 2 and 3).
class FrictionEstimator {
 public:
  struct Sensor {
    double pitch_mm = 0;
    double reach_mm = 10;  ///< how far a contact may jump from frame to frame and be the same
    /// Of a reading, N; unset: a sixty-fourth of the largest force of each contact.
    std::optional<double> noise_n;
    SegmentEnd segment_end = {};
  };

  /// `members`: threads that may call learn() at the same time.
  FrictionEstimator(const Sensor& sensor, const FrictionKnowledge& knowledge, std::size_t members,
                    const ContactParameters& parameters = {});

  /// Begins a frame: hands each contact of the map what was believed of the one that it was.
  void begin(const ContactLabels& map);

  /// Brings what is believed of one contact up to date with the frame that was begun. Of any force
  /// on an ambiguous pillar's segment the same is learnt. For different contacts in any thread, at
  /// a time by one of each `member`.
  void learn(const ForceFieldView& forces, const ContactLabels& map, std::uint32_t contact,
             std::size_t member);

  [[nodiscard]] std::span<const ContactFriction> friction() const { return friction_; }
  [[nodiscard]] const ContactModel& model(std::uint32_t contact) const { return models_[contact]; }

 private:
  /// Memory of one member.
  struct Workspace {
    ContactSamples samples;
    std::vector<ShownRatio> predicted;
  };

  /// Since when a contact has shown a friction.
  struct History {
    double friction = 0;
    double mean_ratio = 0;  ///< of its pillars, then
    bool stayed = false;    ///< while that changed
  };

  void predict(const ForceFieldView& forces, const ContactModel& model, Workspace& work) const;
  [[nodiscard]] bool is_face(Workspace& work) const;
  bool stays(double friction, bool observed, const Workspace& work, History& history) const;
  [[nodiscard]] ContactFriction reported(std::uint32_t contact, const FrictionCurve& log_likelihood,
                                         Workspace& work);

  Sensor sensor_;
  ContactParameters parameters_;
  FrictionLikelihood likelihood_;
  FrictionBelief prior_;
  std::optional<double> given_;
  bool remember_;
  ContactTraces traces_;
  ContactTraces traces_before_;
  std::vector<FrictionBelief> beliefs_;
  std::vector<FrictionBelief> beliefs_before_;
  std::vector<History> histories_;
  std::vector<History> histories_before_;
  std::vector<ContactModel> models_;
  std::vector<ContactFriction> friction_;
  std::vector<Workspace> workspaces_;
};

}  // namespace pillarfield
