#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/contact_sum.h"
#include "core/friction_plateau.h"
#include "pillarfield/contact_map.h"
#include "pillarfield/contact_quantities.h"
#include "pillarfield/force_field.h"

namespace pillarfield {

/// The normal force of a contact's pillars by what they tell of its slip, quanta; pillars that do
/// not press are left out.
struct SlipSum {
  std::int64_t slipping = 0;
  std::int64_t sticking = 0;
  std::int64_t open = 0;  ///< of pillars whose ratio of shear to normal force is not known
};

/// Reads a field as whole numbers, contact by contact.
class ContactMeasure {
 public:
  /// `scratch` is cleared whenever it is used; it is kept from frame to frame for its memory.
  ContactMeasure(const ForceFieldView& forces, double pillar_pitch_mm, FrictionHistogram& scratch);

  [[nodiscard]] ContactSum sum(std::span<const ContactRun> runs) const;

  /// The friction that the pillars of a contact show. Those that bear a quarter of its `peak` or
  /// more are asked, weighted with their normal force: noise moves the ratio of the others.
  [[nodiscard]] std::optional<double> friction(std::span<const ContactRun> runs,
                                               std::int64_t peak) const;

  [[nodiscard]] SlipSum slip(std::span<const ContactRun> runs, double friction) const;

  /// All but the slip.
  [[nodiscard]] ContactQuantities quantities(const ContactSum& sum) const;

 private:
  [[nodiscard]] PillarForce pillar(std::uint32_t row, std::uint32_t col) const;

  template <class Visit>
  void visit(std::span<const ContactRun> runs, Visit visit_pillar) const;

  ForceFieldView forces_;
  double pitch_mm_;
  ForceQuanta quanta_;
  FrictionHistogram& histogram_;
};

/// Adds what a friction says of a contact's slip. `slip` is that of ContactMeasure with it.
void set_slip(ContactQuantities& contact, double friction, FrictionSource source,
              const SlipSum& slip);

}  // namespace pillarfield
