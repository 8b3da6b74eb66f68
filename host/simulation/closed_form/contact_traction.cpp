#include "simulation/closed_form/contact_traction.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <utility>

#include "simulation/closed_form/pillar_shares.h"
#include "simulation/path_place.h"

namespace pillarfield {
namespace {

PlaneVector unit_vector(double angle_deg) {
  const double angle = angle_deg * std::numbers::pi / 180;
  return {std::cos(angle), std::sin(angle)};
}

/// The corner functions of a spin counter-clockwise (C12): of its x component times −1, and of its
/// y component.
struct SpinCorners {
  CornerFunction x;
  CornerFunction y;
};

/// W(y, x) of a corner function W(x, y).
template <CornerFunction corner>
void swapped(std::span<const double> x, std::span<const double> y, std::span<double> values) {
  corner(y, x, values);
}

SpinCorners spin_corners(ContactShape shape) {
  if (shape == ContactShape::sphere) return {sphere_spin_corner, swapped<sphere_spin_corner>};
  return {punch_spin_corner, swapped<punch_spin_corner>};
}

/// A contact at an instant, over the pillars of its bounding box.
class Footprint {
 public:
  Footprint(const ClosedFormContact& contact, const ContactKey& state, const PillarGrid& grid)
      : contact_(contact),
        grid_(grid),
        centre_{state.x_mm, state.y_mm},
        direction_(unit_vector(contact.direction_deg)),
        radius_mm_(contact_radius_mm(contact, state.load_n)),
        box_(grid.box_around(centre_, reach())) {}

  [[nodiscard]] const PillarBox& box() const { return box_; }
  [[nodiscard]] PlaneVector direction() const { return direction_; }

  /// Fractions of the normal load.
  [[nodiscard]] Shares pressure() const { return pressure_within(centre_, radius_mm_); }

  /// First moments of the pressure of a normal load of 1.
  [[nodiscard]] ShareMoments moments() const {
    if (is_cylinder()) {
      return strip_moments(grid_, box_, {centre_, direction_, radius_mm_, contact_.length_mm});
    }
    return disc_moments(grid_, box_, {centre_, radius_mm_}, pressure_corner_function());
  }

  /// Reduction of full-sliding shear by the stick zone: concentric under a sphere (C11), at the
  /// leading edge under a roller (C20).
  [[nodiscard]] Shares stick() const {
    const double slip_share = 1 - contact_.tangential_ratio;
    if (!is_cylinder()) return pressure_within(centre_, radius_mm_ * std::cbrt(slip_share));
    const double half_width = radius_mm_ * std::sqrt(slip_share);
    const double shift = radius_mm_ - half_width;
    return pressure_within({centre_.x + shift * direction_.x, centre_.y + shift * direction_.y},
                           half_width);
  }

  /// Fractions of one component of the spin's shear.
  [[nodiscard]] Shares spin(CornerFunction corner) const {
    return disc_shares(grid_, box_, {centre_, radius_mm_}, corner);
  }

 private:
  [[nodiscard]] bool is_cylinder() const { return contact_.shape == ContactShape::cylinder; }

  [[nodiscard]] CornerFunction pressure_corner_function() const {
    return contact_.shape == ContactShape::sphere ? sphere_pressure_corner : punch_pressure_corner;
  }

  [[nodiscard]] PlaneVector reach() const {
    if (!is_cylinder()) return {radius_mm_, radius_mm_};
    const double along = contact_.length_mm / 2;
    const PlaneVector d{std::abs(direction_.x), std::abs(direction_.y)};
    return {radius_mm_ * d.x + along * d.y, radius_mm_ * d.y + along * d.x};
  }

  [[nodiscard]] Shares pressure_within(PlaneVector centre, double radius_mm) const {
    if (is_cylinder()) {
      return strip_shares(grid_, box_, {centre, direction_, radius_mm, contact_.length_mm});
    }
    Shares shares = disc_shares(grid_, box_, {centre, radius_mm}, pressure_corner_function());
    // Rounding may make a cell at the rim negative.
    for (double& share : shares) share = std::max(0.0, share);
    return shares;
  }

  const ClosedFormContact& contact_;
  const PillarGrid& grid_;
  PlaneVector centre_;
  PlaneVector direction_;
  double radius_mm_;
  PillarBox box_;
};

/// Adds force_n·shares to the pillars of a box in one plane of a field.
void add_shares(const Shares& shares, double force_n, const PillarBox& box,
                std::uint32_t field_cols, std::vector<float>& plane) {
  std::size_t share = 0;
  for (std::uint32_t row = 0; row < box.rows; ++row) {
    std::size_t pillar = std::size_t{box.first_row + row} * field_cols + box.first_col;
    for (std::uint32_t col = 0; col < box.cols; ++col, ++share, ++pillar) {
      plane[pillar] = static_cast<float>(plane[pillar] + force_n * shares[share]);
    }
  }
}

/// Fractions of µP along the direction of motion: those of the pressure in full sliding (C10),
/// minus the stick zone's reduction, if any.
Shares tangential_shares(const ClosedFormContact& contact, const Footprint& footprint,
                         Shares pressure) {
  if (contact.motion == ContactMotion::slide) return pressure;
  const Shares stick = footprint.stick();
  for (std::size_t i = 0; i < pressure.size(); ++i) {
    pressure[i] -= (1 - contact.tangential_ratio) * stick[i];
  }
  return pressure;
}

}  // namespace

ContactKey state_at(const ClosedFormContact& contact, double time_s) {
  const auto [from, to, fraction] = place_on(contact.path, time_s);
  return {time_s, std::lerp(from.x_mm, to.x_mm, fraction), std::lerp(from.y_mm, to.y_mm, fraction),
          std::lerp(from.load_n, to.load_n, fraction)};
}

double contact_radius_mm(const ClosedFormContact& contact, double load_n) {
  const double ratio = load_n / contact.reference_load_n;
  switch (contact.shape) {
    case ContactShape::sphere:
      return contact.contact_radius_mm * std::cbrt(ratio);
    case ContactShape::cylinder:
      return contact.contact_radius_mm * std::sqrt(ratio);
    case ContactShape::flat_punch:
      break;
  }
  return contact.contact_radius_mm;
}

void add_contact(const ClosedFormContact& contact, const ContactKey& state, double pitch_mm,
                 ForceField& forces) {
  if (!(state.load_n > 0)) return;
  const PillarGrid grid(forces.rows, forces.cols, pitch_mm);
  const Footprint footprint(contact, state, grid);
  const auto add = [&](const Shares& shares, double force_n, std::vector<float>& plane) {
    add_shares(shares, force_n, footprint.box(), forces.cols, plane);
  };
  Shares pressure = footprint.pressure();
  add(pressure, state.load_n, forces.normal);
  if (contact.motion == ContactMotion::press) return;

  const double friction_n = contact.friction * state.load_n;
  if (contact.motion == ContactMotion::spin) {
    const SpinCorners corners = spin_corners(contact.shape);
    const double turning_n = contact.clockwise ? -friction_n : friction_n;
    add(footprint.spin(corners.x), -turning_n, forces.shear_x);
    add(footprint.spin(corners.y), turning_n, forces.shear_y);
    return;
  }
  const Shares tangential = tangential_shares(contact, footprint, std::move(pressure));
  add(tangential, friction_n * footprint.direction().x, forces.shear_x);
  add(tangential, friction_n * footprint.direction().y, forces.shear_y);
}

void add_pressure_moments(const ClosedFormContact& contact, const ContactKey& state,
                          double pitch_mm, std::uint32_t rows, std::uint32_t cols,
                          PressureMoments& moments) {
  if (!(state.load_n > 0)) return;
  const PillarGrid grid(rows, cols, pitch_mm);
  const Footprint footprint(contact, state, grid);
  const PillarBox& box = footprint.box();
  const ShareMoments shares = footprint.moments();
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const std::size_t pillar = (box.first_row + i / box.cols) * cols + box.first_col + i % box.cols;
    moments.x[pillar] += state.load_n * shares[i].x;
    moments.y[pillar] += state.load_n * shares[i].y;
  }
}

}  // namespace pillarfield
