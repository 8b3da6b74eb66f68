#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/closed_form_contacts.h"
#include "evaluation/contact_study.h"

/// Single frames of contacts whose pressure and shear are closed forms.
namespace pillarfield::contact_study {

/// A contact at a friction, seen through noise.
struct ClosedForm {
  std::string contact_name;  ///< "sphere 30, partial slip 0.7 at 94°"
  StudyContact contact;
  double friction = 1;
  double noise_counts = 0.5;  ///< normal, standard deviation; the threshold is four times that
  std::uint64_t seed = 1;
  std::shared_ptr<const PillarLoads> loads;  ///< those of the contact, from integrate()

  [[nodiscard]] std::string name() const;  ///< with friction and noise
  [[nodiscard]] Family family() const { return family_of(contact.body.shape); }
  [[nodiscard]] Motion motion() const { return contact.drive.motion; }
};

/// The contacts whose name contains `filter`, each at noises of 0.25, 0.5 and 1 counts and at
/// several frictions. Their loads are not there yet.
[[nodiscard]] std::vector<ClosedForm> closed_forms(std::string_view filter = {});

/// Adds the loads, each contact integrated once; 4 s for all of them.
void integrate(std::vector<ClosedForm>& scenes);

/// One frame of float32 readings, 320 counts per newton, of a scene that has its loads.
[[nodiscard]] Recording record(const ClosedForm& scene);

}  // namespace pillarfield::contact_study
