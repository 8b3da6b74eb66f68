#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "lab/studies/closed_form_contacts.h"
#include "lab/studies/contact_study.h"

/// Single frames of closed-form contacts.
namespace pillarfield::contact_study {

/// A contact at one friction and noise.
struct ClosedForm {
  std::string contact_name;  ///< "sphere 30, partial slip 0.7 at 94°"
  StudyContact contact;
  double friction = 1;
  double noise_counts = 0.5;  ///< standard deviation; the threshold is four times that
  std::uint64_t seed = 1;
  std::shared_ptr<const PillarLoads> loads;  ///< of the contact, set by integrate()

  [[nodiscard]] std::string name() const;  ///< includes friction and noise
  [[nodiscard]] Family family() const { return family_of(contact.body.shape); }
  [[nodiscard]] Motion motion() const { return contact.tangential.motion; }
};

/// The contacts whose name contains `filter`, at noises of 0.25, 0.5 and 1 counts and several
/// frictions. Loads are not set.
[[nodiscard]] std::vector<ClosedForm> closed_forms(std::string_view filter = {});

/// Sets the loads, integrating each contact once; 4 s for all.
void integrate(std::vector<ClosedForm>& scenes);

/// Records one frame of float32 readings, 320 counts per newton. Needs the scene's loads.
[[nodiscard]] Recording record(const ClosedForm& scene);

}  // namespace pillarfield::contact_study
