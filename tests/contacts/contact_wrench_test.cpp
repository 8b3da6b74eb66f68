// Force and moment of contacts in the body's frame, compared with closed forms.

#include <gtest/gtest.h>

#include <cmath>

#include "pillarfield/contact_tracker.h"
#include "pillarfield/error.h"
#include "pillarfield/status.h"

namespace pillarfield {
namespace {

constexpr double kWrenchPitchMm = 1.265;
constexpr std::uint32_t kStripRows = 20;
constexpr std::uint32_t kStripCols = 60;

/// A contact over columns [first, end) of all rows.
ForceField strip(std::uint32_t first, std::uint32_t end, float shear_x, float shear_y,
                 float normal) {
  ForceField field(kStripRows, kStripCols);
  for (std::uint32_t row = 0; row < kStripRows; ++row) {
    for (std::uint32_t col = first; col < end; ++col) {
      const std::size_t i = row * kStripCols + col;
      field.shear_x[i] = shear_x;
      field.shear_y[i] = shear_y;
      field.normal[i] = normal;
      field.status[i] = status::kUsable;
    }
  }
  return field;
}

FrameContacts found_on(const Surface& surface, const ForceField& field) {
  ContactOptions options;
  options.surface = surface;
  ContactTracker tracker(kWrenchPitchMm, options);
  return tracker.update(field.view(), 0);
}

void expect_near(const Vector3& a, const Vector3& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(ContactWrench, OnAPlaneIsTheContactsForceAndMoment) {
  ForceField field = strip(10, 14, 0.1F, -0.2F, 0.5F);
  const ForceField other = strip(40, 47, -0.3F, 0.1F, 0.9F);
  for (std::size_t i = 0; i < field.elements(); ++i) {
    if (other.status[i] == 0) continue;
    field.shear_x[i] = other.shear_x[i] * static_cast<float>(i % 7);
    field.shear_y[i] = other.shear_y[i];
    field.normal[i] = other.normal[i] * static_cast<float>(i % 5);
    field.status[i] = status::kUsable;
  }
  const FrameContacts frame = found_on({}, field);
  ASSERT_EQ(frame.contacts.size(), 2U);
  const auto expect_flat = [](const ContactQuantities& contact) {
    const Moment moment = moment_about({0, 0}, contact);
    expect_near(contact.wrench->force_n, {contact.shear_x_n, contact.shear_y_n, -contact.normal_n},
                1e-9);
    expect_near(contact.wrench->moment_nmm, {moment.x_nmm, moment.y_nmm, moment.z_nmm}, 1e-7);
  };
  for (const TrackedContact& contact : frame.contacts) expect_flat(contact.quantities);
  expect_flat(frame.total);
}

/// Uniform traction on an arc of a cylinder of 60 mm radius, by integration.
TEST(ContactWrench, OnACylinderIsTheIntegralOfItsTractions) {
  Surface cylinder;
  cylinder.shape = SurfaceShape::cylinder;
  const std::uint32_t first = 22;
  const std::uint32_t end = 58;
  const float pillar_n = 0.02F;
  const double length = kStripRows * kWrenchPitchMm;
  for (const double radius : {60.0, -60.0}) {
    cylinder.radius_mm = radius;
    const double from = (first - kStripCols / 2.0) * kWrenchPitchMm / radius;
    const double to = (end - kStripCols / 2.0) * kWrenchPitchMm / radius;
    const double per_radian =
        double{pillar_n} / (kWrenchPitchMm * kWrenchPitchMm) * radius * length;

    // Pressure passes through the axis, (0, 0, −radius).
    const Wrench pressed = *found_on(cylinder, strip(first, end, 0, 0, pillar_n)).total.wrench;
    const double force_x = per_radian * (std::cos(to) - std::cos(from));
    const double force_z = -per_radian * (std::sin(to) - std::sin(from));
    const double size = std::hypot(force_x, force_z);
    expect_near(pressed.force_n, {force_x, 0, force_z}, 1e-3 * size);
    expect_near(pressed.moment_nmm, {0, -radius * force_x, 0}, 1e-3 * size * 60);

    // Shear around the axis has the arm `radius`.
    const Wrench turned = *found_on(cylinder, strip(first, end, pillar_n, 0, 0)).total.wrench;
    const double along_x = per_radian * (std::sin(to) - std::sin(from));
    const double along_z = per_radian * (std::cos(to) - std::cos(from));
    expect_near(turned.force_n, {along_x, 0, along_z}, 1e-3 * size);
    expect_near(turned.moment_nmm, {0, per_radian * radius * (to - from) - radius * along_x, 0},
                1e-3 * size * 60);
  }
}

TEST(ContactWrench, IsUnsetWithoutASurface) {
  ContactTracker tracker(kWrenchPitchMm);
  const ForceField field = strip(1, 3, 0, 0, 1);
  const FrameContacts& frame = tracker.update(field.view(), 0);
  EXPECT_FALSE(frame.total.wrench || frame.contacts.front().quantities.wrench);
}

TEST(ContactWrench, RefusesASurfaceThatDoesNotFit) {
  Surface map;
  map.shape = SurfaceShape::height_map;
  map.heights_mm.assign(3, 0);
  EXPECT_THROW(found_on(map, strip(1, 3, 0, 0, 1)), Error);
}

}  // namespace
}  // namespace pillarfield
