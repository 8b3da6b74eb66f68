#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pillarfield {

/// Forces of pillars as whole numbers of kForceQuantum, so that sums of them are the same bits in
/// whatever order they are added.
///
/// A pillar's force is rounded to the nearest quantum, halves away from zero, and held within
/// ±largest_n(); NaN counts as zero. A patch of fewer than 2^25 pillars leaves 8192 N to each, a
/// larger one so much less that no sum can overflow: 256 N on the largest that a skin can have.
class ForceQuanta {
 public:
  static constexpr double kForceQuantum = 0x1p-24;  ///< N, some 60 nN

  /// For a patch of so many pillars, fewer than 2^30.
  explicit ForceQuanta(std::uint64_t pillars);

  [[nodiscard]] std::int64_t of(float force_n) const {
    if (std::isnan(force_n)) return 0;
    const double held = std::clamp(force_n / kForceQuantum, -largest_, largest_);
    // Exact, for a float leaves room for the half; and much faster than llrint.
    return static_cast<std::int64_t>(held + std::copysign(0.5, held));
  }
  [[nodiscard]] double largest_n() const { return largest_ * kForceQuantum; }

 private:
  double largest_;  ///< quanta
};

/// An exact sum of products of a force in quanta and a place of at most ±2^15 half pitches.
class MomentSum {
 public:
  void add(std::int64_t force, std::int64_t place) {
    // Each part times a place, summed over all pillars of the largest patch, fits into 63 bits.
    high_ += (force >> kLowBits) * place;
    low_ += (force & kLowMask) * place;
  }
  /// Adds a sum of products.
  void add_product(std::int64_t product) {
    high_ += product >> kLowBits;
    low_ += product & kLowMask;
  }
  void add(const MomentSum& other) {
    high_ += other.high_;
    low_ += other.low_;
  }

  /// Quanta times half pitches; rounded at the end only.
  [[nodiscard]] double value() const;

 private:
  static constexpr int kLowBits = 15;
  static constexpr std::int64_t kLowMask = (std::int64_t{1} << kLowBits) - 1;
  std::int64_t high_ = 0;
  std::int64_t low_ = 0;
};

/// A pillar of a contact, its forces in quanta and its place in half pitches from the patch's
/// centre, x right and y up: odd or even as the patch has even or odd columns.
struct PillarForce {
  std::int64_t shear_x = 0;
  std::int64_t shear_y = 0;
  std::int64_t normal = 0;
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::uint8_t status = 0;
};

/// What is summed over the pillars of a contact. Adding is associative and commutative, bit for
/// bit.
struct ContactSum {
  std::int64_t shear_x = 0;  ///< quanta, as the other forces
  std::int64_t shear_y = 0;
  std::int64_t normal = 0;
  MomentSum normal_x;   ///< of normal times x
  MomentSum normal_y;   ///< of normal times y
  MomentSum shear_y_x;  ///< of shear_y times x, which is the one part of the torque
  MomentSum shear_x_y;  ///< of shear_x times y, the other
  std::int64_t x = 0;   ///< half pitches
  std::int64_t y = 0;
  std::int64_t pillars = 0;
  std::int64_t ambiguous = 0;
  std::int64_t resolved = 0;  ///< of these, with the neighbours' help
  std::int64_t peak = INT64_MIN;
  std::int64_t peak_x = 0;
  std::int64_t peak_y = 0;

  void add(const PillarForce& pillar);
  void add(const ContactSum& other);
  /// Of equal peaks the one that comes first row by row counts.
  void add_peak(std::int64_t candidate, std::int64_t at_x, std::int64_t at_y);
};

}  // namespace pillarfield
