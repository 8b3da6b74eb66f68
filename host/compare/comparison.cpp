#include "pillarfield/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include "pillarfield/error.h"
#include "simulation/ideal_readings.h"
#include "solve/pillar_maths.h"

namespace pillarfield {
namespace {

using double_precision::Direction;
using double_precision::Force;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Counts of positive values in classes 2 % wide, from 1e-15 to 1e15.
class LogHistogram {
 public:
  void add(double value) { ++counts_[class_of(value)]; }

  void add(const LogHistogram& other) {
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
  }

  /// The least value that the given share of the values does not exceed, rounded up to the end of
  /// its class; 0 where it is below the first class.
  [[nodiscard]] double quantile(double share) const {
    std::uint64_t total = 0;
    for (const std::uint64_t count : counts_) total += count;
    const double wanted = share * static_cast<double>(total);
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i + 1 < counts_.size(); ++i) {
      seen += counts_[i];
      if (static_cast<double>(seen) >= wanted) return end_of(i);
    }
    return kInfinite;
  }

 private:
  static constexpr double kLeast = 1e-15;  // see comparison.h
  static constexpr double kWidth = 1.02;
  static constexpr std::size_t kClasses = 3490;

  /// Class 0 is for what lies below kLeast, the last one for what lies beyond all classes.
  static std::size_t class_of(double value) {
    if (value <= kLeast) return 0;
    const double index = std::ceil(std::log(value / kLeast) / std::log(kWidth));
    return static_cast<std::size_t>(std::min(index, static_cast<double>(kClasses - 1)));
  }

  static double end_of(std::size_t index) {
    return index == 0 ? 0 : kLeast * std::pow(kWidth, static_cast<double>(index));
  }

  std::vector<std::uint64_t> counts_ = std::vector<std::uint64_t>(kClasses);
};

/// The errors of one pillar.
struct PillarErrors {
  bool status_mismatch = false;
  double error_n = 0;
  double relative = 0;
  double theta_rad = 0;
  double phi_rad = 0;  ///< times sin(theta)
};

/// Sums over the pillars of a region.
struct Sums {
  std::uint64_t pillars = 0;
  std::uint64_t status_mismatches = 0;
  double error_squared = 0;
  double relative_squared = 0;
  double theta_squared = 0;
  double phi_squared = 0;
  LogHistogram error;
  LogHistogram relative;

  void add(const PillarErrors& errors) {
    ++pillars;
    status_mismatches += errors.status_mismatch ? 1 : 0;
    error_squared += errors.error_n * errors.error_n;
    relative_squared += errors.relative * errors.relative;
    theta_squared += errors.theta_rad * errors.theta_rad;
    phi_squared += errors.phi_rad * errors.phi_rad;
    error.add(errors.error_n);
    relative.add(errors.relative);
  }

  void add(const Sums& other) {
    pillars += other.pillars;
    status_mismatches += other.status_mismatches;
    error_squared += other.error_squared;
    relative_squared += other.relative_squared;
    theta_squared += other.theta_squared;
    phi_squared += other.phi_squared;
    error.add(other.error);
    relative.add(other.relative);
  }

  [[nodiscard]] RegionErrors errors() const {
    RegionErrors result;
    if (pillars == 0) return result;
    const auto root_mean = [&](double sum) {
      return std::sqrt(sum / static_cast<double>(pillars));
    };
    result.pillars = pillars;
    result.status_mismatches = status_mismatches;
    result.rms_n = root_mean(error_squared);
    result.p95_n = error.quantile(0.95);
    result.rms_relative = root_mean(relative_squared);
    result.p95_relative = relative.quantile(0.95);
    result.theta_rms_rad = root_mean(theta_squared);
    result.phi_rms_rad = root_mean(phi_squared);
    return result;
  }
};

bool has_pillars(const ForceFieldView& field) { return !field.shear_x.empty(); }

Force force_of(const ForceFieldView& field, std::size_t pillar) {
  if (!has_pillars(field)) return {0, 0, field.normal[pillar]};
  return {field.shear_x[pillar], field.shear_y[pillar], field.normal[pillar]};
}

bool is_finite(Force force) {
  return std::isfinite(force.shear_x) && std::isfinite(force.shear_y) &&
         std::isfinite(force.normal);
}

double distance(Force a, Force b) {
  return std::hypot(a.shear_x - b.shear_x, a.shear_y - b.shear_y, a.normal - b.normal);
}

/// Errors of a solved force in magnitude and angle if the truth loads the pillar. For NaN the error
/// is infinite and the direction opposite.
PillarErrors errors_of(Force solved, Force truth) {
  using std::numbers::pi;
  const Direction expected = double_precision::direction_of(truth);
  if (!is_finite(solved)) return {true, kInfinite, kInfinite, pi, pi * std::sin(expected.theta)};
  const Direction found = double_precision::direction_of(solved);
  PillarErrors errors;
  errors.error_n = distance(solved, truth);
  errors.relative = errors.error_n / expected.magnitude;
  errors.theta_rad = found.theta - expected.theta;
  errors.phi_rad = std::remainder(found.phi - expected.phi, 2 * pi) * std::sin(expected.theta);
  return errors;
}

/// Errors of a solved force if the truth leaves the pillar unloaded: no angular error.
PillarErrors errors_at_rest(Force solved, Force truth) {
  PillarErrors errors;
  errors.status_mismatch = !is_finite(solved);
  errors.error_n = is_finite(solved) ? distance(solved, truth) : kInfinite;
  return errors;
}

void check_planes(const ForceFieldView& field, const char* which) {
  const std::size_t pillars = std::size_t{field.rows} * field.cols;
  for (const auto& plane : {field.shear_x, field.shear_y, field.normal}) {
    if (plane.size() == pillars) continue;
    if (plane.empty() && !has_pillars(field) && field.normal.size() == pillars) continue;
    throw Error(which, "lack a plane of force", "give shear_x, shear_y and normal");
  }
}

void check_pair(const ForceFieldView& solved, const ForceFieldView& truth) {
  check_planes(solved, "solved forces");
  check_planes(truth, "true forces");
  if (has_pillars(solved) != has_pillars(truth)) {
    throw Error("solved forces", "and the truth are not both of pillars",
                "solve with the layout of the truth");
  }
  const std::size_t pillars = truth.normal.size();
  if (solved.rows != truth.rows || solved.cols != truth.cols || solved.status.size() != pillars) {
    throw Error("solved forces",
                fmt::format("have {} x {} pillars and {} status bytes", solved.rows, solved.cols,
                            solved.status.size()),
                fmt::format("the truth has {} x {}", truth.rows, truth.cols));
  }
  for (std::size_t pillar = 0; pillar < pillars; ++pillar) {
    if (is_finite(force_of(truth, pillar))) continue;
    throw Error(
        "true forces",
        fmt::format("have a NaN at row {}, column {}", pillar / truth.cols, pillar % truth.cols),
        "compare with a truth that is whole");
  }
}

/// The usable sensels of the ideal model.
std::uint8_t ideal_usable_bits(const ForceFieldView& truth, std::size_t pillar) {
  const Force expected = force_of(truth, pillar);
  if (has_pillars(truth)) return usable_bits(ideal_readings(expected, 1));
  return expected.normal > 0 ? status::kSensel1 : 0;
}

}  // namespace

struct Comparison::State {
  std::array<Sums, kRegions> regions;
};

Comparison::Comparison() : state_(std::make_unique<State>()) {}
Comparison::~Comparison() = default;
Comparison::Comparison(Comparison&&) noexcept = default;
Comparison& Comparison::operator=(Comparison&&) noexcept = default;

void Comparison::add(const ForceFieldView& solved, const ForceFieldView& truth) {
  check_pair(solved, truth);
  for (std::size_t pillar = 0; pillar < truth.normal.size(); ++pillar) {
    const Force expected = force_of(truth, pillar);
    const Force found = force_of(solved, pillar);
    const std::uint8_t usable = ideal_usable_bits(truth, pillar);
    PillarErrors errors =
        usable == 0 ? errors_at_rest(found, expected) : errors_of(found, expected);
    errors.status_mismatch |= (solved.status[pillar] & status::kUsable) != usable;
    state_->regions[static_cast<std::size_t>(region_of(usable))].add(errors);
  }
}

RegionErrors Comparison::region(Region region) const {
  return state_->regions[static_cast<std::size_t>(region)].errors();
}

RegionErrors Comparison::loaded() const {
  Sums all;
  for (std::size_t i = 0; i < state_->regions.size(); ++i) {
    if (static_cast<Region>(i) != Region::none) all.add(state_->regions[i]);
  }
  return all.errors();
}

}  // namespace pillarfield
