#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "contacts/contact_matching.h"
#include "contacts/estimator/contact_parameters.h"
#include "contacts/estimator/contact_samples.h"
#include "contacts/estimator/friction_likelihood.h"
#include "contacts/estimator/friction_posterior.h"
#include "contacts/estimator/past_pressure.h"
#include "contacts/estimator/pressure_regression.h"
#include "contacts/fading_line.h"
#include "pillarfield/contact_labels.h"
#include "pillarfield/force_field.h"
#include "pillarfield/friction.h"

namespace pillarfield {

/// The model from which the ambiguous pillars of a contact are estimated.
struct ContactModel {
  static constexpr std::size_t kNodes = 6;

  ContactBox box;
  std::array<float, kNodes> frictions{};  ///< of equal probability
  std::array<float, kNodes> cautious{};   ///< likewise, by FrictionBelief::cautious
  std::optional<PressureRegression> pressure;
  double noise_n = 0;
  bool any_ambiguous = false;  ///< false only if no pillar is ambiguous
};

/// Knowledge of the friction of a contact.
struct FrictionBelief {
  FrictionPosterior estimate;  ///< for the forces
  /// For their intervals, with a wider prior and sticking pillars as lower bounds only (C8a).
  FrictionPosterior cautious;
};

/// Estimates the friction of each contact from frame to frame: a posterior over the coefficient,
/// carried over along contact tracks (docs/derivations/contact.md, sections 2 and 3).
class FrictionEstimator {
 public:
  struct Sensor {
    double pitch_mm = 0;
    double reach_mm = 10;  ///< largest movement of a contact between frames
    /// Noise of a reading as a force, N; unset: 1/64 of the largest force of each contact.
    std::optional<double> noise_n;
    SegmentModel segment = {};
  };

  /// `members`: number of threads that may call update() concurrently.
  FrictionEstimator(const Sensor& sensor, const FrictionKnowledge& knowledge, std::size_t members,
                    const ContactParameters& parameters = {});

  /// Begins a frame: each contact takes over the posterior of the earlier contact it continues.
  void begin(const ForceFieldView& forces, const ContactLabels& labels);

  /// Updates the posterior of one contact with the frame begun. The result does not depend on where
  /// the force of an ambiguous pillar lies on its segment. Thread-safe for different contacts with
  /// different `member`, while no force is written: leans depend on pillars of other contacts.
  void update(const ForceFieldView& forces, const ContactLabels& labels, std::uint32_t contact,
              std::size_t member);

  [[nodiscard]] std::span<const ContactFriction> friction() const { return friction_; }
  [[nodiscard]] const ContactModel& model(std::uint32_t contact) const { return models_[contact]; }
  /// The leans of the ambiguous pillars of updated contacts, [rows, cols]; empty without an arm.
  [[nodiscard]] std::span<const LeanShear> leans() const { return leans_; }
  [[nodiscard]] const PastPressure& past() const { return past_; }

 private:
  /// Memory of one thread.
  struct Workspace {
    ContactSamples samples;
    std::vector<ObservedRatio> predicted;
  };

  /// Evidence that a contact's friction does not grow with its load (section 5).
  struct History {
    FadingLine growth;      ///< logarithm of a frame's friction over that of its load ratio
    double most_ratio = 0;  ///< largest load ratio so far
    double log_ratio = 0;   ///< the newest point of `growth`
    double log_friction = 0;
    PastPressure::Movement travel;  ///< since a frame first showed `log_friction_then`
    double log_friction_then = 0;
    std::optional<double> friction;  ///< the last one shown
  };

  void predict(const ForceFieldView& forces, const ContactModel& model, Workspace& work) const;
  [[nodiscard]] bool stays(double friction, const FrictionPosterior::Summary& now,
                           double load_ratio, History& history) const;
  [[nodiscard]] bool slides(std::uint32_t contact, double friction, bool one_ratio,
                            const ContactSamples& samples, History& history) const;
  [[nodiscard]] ContactFriction reported(std::uint32_t contact, const FrictionCurve& log_likelihood,
                                         const ContactSamples& samples);

  Sensor sensor_;
  ContactParameters parameters_;
  FrictionLikelihood likelihood_;
  FrictionBelief prior_;
  double prior_least_;  ///< the friction that the cautious prior exceeds in 19 of 20 cases
  std::optional<double> given_;
  bool carries_over_;
  ContactSnapshot snapshot_;
  ContactSnapshot earlier_snapshot_;
  std::vector<FrictionBelief> beliefs_;
  std::vector<FrictionBelief> earlier_beliefs_;
  std::vector<History> histories_;
  std::vector<History> earlier_histories_;
  std::vector<ContactModel> models_;
  std::vector<ContactFriction> friction_;
  std::vector<Workspace> workspaces_;
  std::vector<LeanShear> leans_;
  PastPressure past_;
  std::vector<PastPressure::Movement> movements_;  ///< of the contacts, since the frame before
};

}  // namespace pillarfield
