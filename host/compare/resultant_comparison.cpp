#include "pillarfield/resultant_comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>

#include "contacts/contact_measure.h"
#include "contacts/contact_sum.h"
#include "pillarfield/error.h"
#include "simulation/ideal_readings.h"

namespace pillarfield {
namespace {

using Vector = std::array<double, 3>;

double length(const Vector& vector) { return std::hypot(vector[0], vector[1], vector[2]); }

double error_between(const Vector& solved, const Vector& truth) {
  const double error = length({solved[0] - truth[0], solved[1] - truth[1], solved[2] - truth[2]});
  return std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
}

struct Resultant {
  Vector force_n = {};
  Vector torque_nmm = {};
};

/// Sum over all pillars, about the centre of the patch.
Resultant resultant_of(const ForceFieldView& field, const Pitch& pitch_mm) {
  Resultant sum;
  for (std::uint32_t row = 0; row < field.rows; ++row) {
    const double y_mm = ((field.rows - 1) / 2.0 - row) * pitch_mm.row_mm;
    for (std::uint32_t col = 0; col < field.cols; ++col) {
      const double x_mm = (col - (field.cols - 1) / 2.0) * pitch_mm.col_mm;
      const std::size_t pillar = std::size_t{row} * field.cols + col;
      const Vector force = {field.shear_x[pillar], field.shear_y[pillar], field.normal[pillar]};
      const Vector torque = {-y_mm * force[2], x_mm * force[2], x_mm * force[1] - y_mm * force[0]};
      for (std::size_t i = 0; i < 3; ++i) {
        sum.force_n[i] += force[i];
        sum.torque_nmm[i] += torque[i];
      }
    }
  }
  return sum;
}

std::vector<ContactQuantities> measure(const ForceFieldView& field, const ContactLabels& labels,
                                       const Pitch& pitch_mm) {
  std::vector<ContactQuantities> contacts;
  contacts.reserve(labels.contacts());
  for (std::uint32_t label = 0; label < labels.contacts(); ++label) {
    contacts.push_back(quantities_of(sum_of(field, labels.runs(label), {}), pitch_mm));
  }
  return contacts;
}

/// Labels of a true and a solved contact.
using Pair = std::pair<std::uint32_t, std::uint32_t>;

/// Matches contacts by the pillars they share.
std::vector<Pair> match(const ContactLabels& truth, const ContactLabels& solved, std::uint32_t cols,
                        std::size_t pillars) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> label_of(pillars, kNone);
  for (const ContactRun& run : solved.runs()) {
    for (std::uint32_t col = run.first; col < run.end; ++col) {
      label_of[std::size_t{run.row} * cols + col] = run.contact;
    }
  }
  std::map<Pair, std::uint64_t> shared;
  for (const ContactRun& run : truth.runs()) {
    for (std::uint32_t col = run.first; col < run.end; ++col) {
      const std::uint32_t label = label_of[std::size_t{run.row} * cols + col];
      if (label != kNone) ++shared[{run.contact, label}];
    }
  }
  std::vector<std::pair<std::uint64_t, Pair>> by_pillars;
  by_pillars.reserve(shared.size());
  for (const auto& [pair, count] : shared) by_pillars.emplace_back(count, pair);
  std::ranges::stable_sort(by_pillars, std::greater(), &std::pair<std::uint64_t, Pair>::first);
  std::vector<bool> has_true(truth.contacts());
  std::vector<bool> has_solved(solved.contacts());
  std::vector<Pair> matched;
  for (const auto& [count, pair] : by_pillars) {
    if (has_true[pair.first] || has_solved[pair.second]) continue;
    has_true[pair.first] = has_solved[pair.second] = true;
    matched.push_back(pair);
  }
  return matched;
}

Vector force_of(const ContactQuantities& contact) {
  return {contact.shear_x_n, contact.shear_y_n, contact.normal_n};
}

void add_pair(const ContactQuantities& solved, const ContactQuantities& truth, std::uint64_t frame,
              ContactErrors& errors) {
  const PatchPlace& place = truth.centre_of_pressure;
  const double torque_nmm = moment_about(place, solved).z_nmm;
  errors.force.add(error_between(force_of(solved), force_of(truth)), length(force_of(truth)),
                   frame);
  errors.torque.add(std::abs(torque_nmm - truth.torque_nmm), std::abs(truth.torque_nmm), frame);
  errors.centre.add(std::hypot(solved.centre_of_pressure.x_mm - place.x_mm,
                               solved.centre_of_pressure.y_mm - place.y_mm),
                    0, frame);
}

/// Counts the contacts that are not matched, and raises `most_n` to their largest normal force.
std::uint64_t count_others(const std::vector<ContactQuantities>& contacts,
                           const std::vector<bool>& is_matched, double& most_n) {
  std::uint64_t others = 0;
  for (std::size_t label = 0; label < contacts.size(); ++label) {
    if (is_matched[label]) continue;
    ++others;
    most_n = std::max(most_n, contacts[label].normal_n);
  }
  return others;
}

}  // namespace

void VectorErrors::add(double error, double true_length, std::uint64_t frame) {
  const auto add_to = [&](double& root_mean, double value) {
    const auto count = static_cast<double>(cases);
    root_mean = std::sqrt((root_mean * root_mean * count + value * value) / (count + 1));
  };
  add_to(rms, error);
  add_to(true_rms, true_length);
  if (cases++ == 0 || error > worst) {
    worst = error;
    worst_frame = frame;
    worst_true = true_length;
  }
}

void ResultantComparison::add(const ForceFieldView& solved, const ForceFieldView& truth) {
  const std::size_t pillars = std::size_t{truth.rows} * truth.cols;
  for (const ForceFieldView* const field : {&solved, &truth}) {
    for (const auto& plane : {field->shear_x, field->shear_y, field->normal}) {
      if (plane.size() == pillars && solved.rows == truth.rows) continue;
      throw Error("solved forces", "differ from the truth in size", "compare forces of one patch");
    }
  }
  add_patch(solved, truth);
  add_contacts(solved, truth);
  ++frames_;
}

void ResultantComparison::add_patch(const ForceFieldView& solved, const ForceFieldView& truth) {
  const Resultant found = resultant_of(solved, element_pitch_mm_);
  const Resultant expected = resultant_of(truth, element_pitch_mm_);
  patch_.force.add(error_between(found.force_n, expected.force_n), length(expected.force_n),
                   frames_);
  patch_.torque.add(error_between(found.torque_nmm, expected.torque_nmm),
                    length(expected.torque_nmm), frames_);
}

void ResultantComparison::add_contacts(const ForceFieldView& solved, const ForceFieldView& truth) {
  true_status_.resize(truth.normal.size());
  for (std::size_t i = 0; i < true_status_.size(); ++i) {
    true_status_[i] =
        usable_bits(ideal_readings({truth.shear_x[i], truth.shear_y[i], truth.normal[i]}, 1));
  }
  true_labels_.find(true_status_, truth.rows, truth.cols);
  solved_labels_.find(solved.status, solved.rows, solved.cols);
  ForceFieldView loaded = truth;
  loaded.status = true_status_;
  const auto expected = measure(loaded, true_labels_, element_pitch_mm_);
  const auto found = measure(solved, solved_labels_, element_pitch_mm_);
  std::vector<bool> is_found(expected.size());
  std::vector<bool> is_true(found.size());
  for (const auto& [of_truth, of_solved] :
       match(true_labels_, solved_labels_, truth.cols, truth.normal.size())) {
    add_pair(found[of_solved], expected[of_truth], frames_, contacts_);
    is_found[of_truth] = is_true[of_solved] = true;
    ++contacts_.found;
  }
  contacts_.missed += count_others(expected, is_found, contacts_.missed_normal_n);
  contacts_.extra += count_others(found, is_true, contacts_.extra_normal_n);
}

}  // namespace pillarfield
