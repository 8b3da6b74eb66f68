#include "contacts/contact_sum.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "pillarfield/status.h"

namespace pillarfield {
namespace {

constexpr int kSumBits = 62;
constexpr int kMostForceBits = 37;

}  // namespace

ForceQuanta::ForceQuanta(std::uint64_t pillars)
    : largest_(std::ldexp(
          1, std::min(kMostForceBits, kSumBits - static_cast<int>(std::bit_width(pillars))))) {}

double MomentSum::value() const {
  // However the sum is divided among the two, the same bits.
  const std::int64_t high = high_ + (low_ >> kLowBits);
  return std::ldexp(static_cast<double>(high), kLowBits) + static_cast<double>(low_ & kLowMask);
}

void ContactSum::add_peak(std::int64_t candidate, std::int64_t at_x, std::int64_t at_y) {
  const bool first = at_y > peak_y || (at_y == peak_y && at_x < peak_x);
  if (candidate < peak || (candidate == peak && !first)) return;
  peak = candidate;
  peak_x = at_x;
  peak_y = at_y;
}

void ContactSum::add(const PillarForce& pillar) {
  shear_x += pillar.shear_x;
  shear_y += pillar.shear_y;
  normal += pillar.normal;
  normal_x.add(pillar.normal, pillar.x);
  normal_y.add(pillar.normal, pillar.y);
  shear_y_x.add(pillar.shear_y, pillar.x);
  shear_x_y.add(pillar.shear_x, pillar.y);
  x += pillar.x;
  y += pillar.y;
  ++pillars;
  if ((pillar.status & (status::kAmbiguous | status::kFromNeighbours)) != 0) ++ambiguous;
  if ((pillar.status & status::kFromNeighbours) != 0) ++resolved;
  add_peak(pillar.normal, pillar.x, pillar.y);
}

void ContactSum::add(const ContactSum& other) {
  if (other.pillars == 0) return;
  shear_x += other.shear_x;
  shear_y += other.shear_y;
  normal += other.normal;
  normal_x.add(other.normal_x);
  normal_y.add(other.normal_y);
  shear_y_x.add(other.shear_y_x);
  shear_x_y.add(other.shear_x_y);
  x += other.x;
  y += other.y;
  pillars += other.pillars;
  ambiguous += other.ambiguous;
  resolved += other.resolved;
  add_peak(other.peak, other.peak_x, other.peak_y);
}

}  // namespace pillarfield
