#pragma once

#include <cstdint>
#include <vector>

#include "pillarfield/contact_labels.h"
#include "pillarfield/force_field.h"

namespace pillarfield {

/// Lengths of a vector's errors |solved − true| over several cases, and of its true values, in one
/// unit. A solved NaN is an infinite error.
struct VectorErrors {
  std::uint64_t cases = 0;
  double rms = 0;                 ///< RMS of the errors
  double worst = 0;               ///< the largest error
  std::uint64_t worst_frame = 0;  ///< its frame, from 0
  double worst_true = 0;          ///< length of the true value there
  double true_rms = 0;            ///< RMS of the true values

  void add(double error, double true_length, std::uint64_t frame);
};

/// Errors of the resultant of all forces of the patch, one case per frame. Torques are about the
/// centre of the patch, with the axes of docs/contacts_found.md: x right, y up, z outwards.
struct ResultantErrors {
  VectorErrors force;   ///< (shear_x, shear_y, normal), N
  VectorErrors torque;  ///< N mm
};

/// Errors by contact, over all frames. A true and a solved contact match if they share pillars: the
/// pair that shares most first, each contact once.
struct ContactErrors {
  std::uint64_t found = 0;     ///< true contacts with a solved one
  std::uint64_t missed = 0;    ///< true contacts without
  std::uint64_t extra = 0;     ///< solved contacts without a true one
  double missed_normal_n = 0;  ///< largest normal force of a missed contact
  double extra_normal_n = 0;   ///< largest normal force of an extra contact
  VectorErrors force;          ///< of found contacts, N
  VectorErrors torque;         ///< about the normal through the true centre of pressure, N mm
  VectorErrors centre;         ///< of pressure, mm; its true values are zero
};

/// Compares resultant forces and torques with the truth, of the patch and by contact.
class ResultantComparison {
 public:
  explicit ResultantComparison(const Pitch& element_pitch_mm)
      : element_pitch_mm_(element_pitch_mm) {}

  /// Adds a frame. True contacts are of the pillars that the truth loads in the ideal model, as for
  /// Comparison; solved contacts follow from the status. Throws Error if sizes differ.
  void add(const ForceFieldView& solved, const ForceFieldView& truth);

  [[nodiscard]] const ResultantErrors& patch() const { return patch_; }
  [[nodiscard]] const ContactErrors& contacts() const { return contacts_; }

 private:
  void add_patch(const ForceFieldView& solved, const ForceFieldView& truth);
  void add_contacts(const ForceFieldView& solved, const ForceFieldView& truth);

  Pitch element_pitch_mm_;
  std::uint64_t frames_ = 0;
  ResultantErrors patch_;
  ContactErrors contacts_;
  std::vector<std::uint8_t> true_status_;
  ContactLabels solved_labels_;
  ContactLabels true_labels_;
};

}  // namespace pillarfield
