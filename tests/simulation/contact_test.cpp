#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "contact_oracle.h"
#include "simulation/closed_form/contact_traction.h"

namespace pillarfield {
namespace {

using std::numbers::pi;

constexpr double kPitch = 1.2649;

/// Every shape with every motion it has.
std::vector<ClosedFormContact> all_kinds() {
  using enum ContactShape;
  using enum ContactMotion;
  std::vector<ClosedFormContact> kinds;
  for (const auto& [shape, motion] :
       std::vector<std::pair<ContactShape, ContactMotion>>{{sphere, press},
                                                           {sphere, slide},
                                                           {sphere, partial_slip},
                                                           {sphere, spin},
                                                           {flat_punch, press},
                                                           {flat_punch, slide},
                                                           {flat_punch, spin},
                                                           {cylinder, press},
                                                           {cylinder, slide},
                                                           {cylinder, roll}}) {
    ClosedFormContact contact;
    contact.shape = shape;
    contact.motion = motion;
    contact.contact_radius_mm = 4;
    contact.length_mm = 11;
    contact.friction = 0.7;
    contact.direction_deg = 25;
    contact.tangential_ratio = 0.6;
    contact.path = {{0, 0.3, -0.2, 2}};
    kinds.push_back(contact);
  }
  return kinds;
}

std::string kind_of(const ClosedFormContact& c) {
  return "shape " + std::to_string(int(c.shape)) + " motion " + std::to_string(int(c.motion)) +
         " radius " + std::to_string(c.contact_radius_mm) + " at " +
         std::to_string(c.path.front().x_mm) + ", " + std::to_string(c.path.front().y_mm) +
         " direction " + std::to_string(c.direction_deg);
}

ForceField field_of(const ClosedFormContact& contact, std::uint32_t pillars,
                    double pitch = kPitch) {
  ForceField field(pillars, pillars);
  add_contact(contact, contact.path.front(), pitch, field);
  return field;
}

/// Force and torque about a point of a whole field.
struct Resultant {
  double x = 0;
  double y = 0;
  double normal = 0;
  double torque = 0;
};

Resultant resultant_of(const ForceField& field, double pitch, double x0 = 0, double y0 = 0) {
  Resultant sum;
  for (std::uint32_t r = 0; r < field.rows; ++r) {
    for (std::uint32_t c = 0; c < field.cols; ++c) {
      const std::size_t i = std::size_t{r} * field.cols + c;
      const double x = (c + 0.5 - field.cols / 2.0) * pitch - x0;
      const double y = (field.rows / 2.0 - r - 0.5) * pitch - y0;
      sum.x += double{field.shear_x[i]};
      sum.y += double{field.shear_y[i]};
      sum.normal += double{field.normal[i]};
      sum.torque += x * double{field.shear_y[i]} - y * double{field.shear_x[i]};
    }
  }
  return sum;
}

double tangential_n(const ClosedFormContact& contact) {
  const double limit = contact.friction * contact.path.front().load_n;
  switch (contact.motion) {
    case ContactMotion::press:
    case ContactMotion::spin:
      return 0;
    case ContactMotion::slide:
      return limit;
    case ContactMotion::partial_slip:
    case ContactMotion::roll:
      break;
  }
  return contact.tangential_ratio * limit;
}

void expect_resultants(const ClosedFormContact& contact, const ForceField& field) {
  const double load = contact.path.front().load_n;
  const double tangential = tangential_n(contact);
  const double angle = contact.direction_deg * pi / 180;
  const Resultant sum = resultant_of(field, kPitch);
  EXPECT_NEAR(sum.normal, load, 1e-6 * load);
  EXPECT_NEAR(sum.x, tangential * std::cos(angle), 1e-6 * load);
  EXPECT_NEAR(sum.y, tangential * std::sin(angle), 1e-6 * load);
}

TEST(Contact, ForcesAddUpToTheLoadForAnyCentreAndRadius) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto one_of = [&](std::initializer_list<double> choices) {
    return choices.begin()[random() % choices.size()];
  };
  for (ClosedFormContact contact : all_kinds()) {
    for (int trial = 0; trial < 200; ++trial) {
      contact.contact_radius_mm = 20 * std::pow(10.0, -2 + 2 * unit(random));
      contact.reference_load_n = std::pow(10.0, unit(random));
      contact.length_mm = 15 + 14.9 * unit(random);
      contact.direction_deg = 360 * unit(random);
      contact.tangential_ratio = 0.5 + 0.499 * unit(random);
      contact.path = {{0, 5 * unit(random), 5 * unit(random), contact.reference_load_n}};
      // Hard places: small, on borders and middles of pillars, along the axes.
      if (trial % 4 > 0)
        contact.contact_radius_mm = one_of({1e-3, 0.3, kPitch / 2, kPitch, 3 * kPitch});
      if (trial % 4 > 1) {
        contact.path[0].x_mm = one_of({0.0, kPitch / 2, kPitch, 1e-13, 0.25 * kPitch});
        contact.path[0].y_mm = -contact.path[0].x_mm;
      }
      if (trial % 4 > 2) contact.direction_deg = one_of({0.0, 45.0, 90.0, 180.0, 1e-9});
      SCOPED_TRACE(kind_of(contact));
      expect_resultants(contact, field_of(contact, 60));
    }
  }
}

TEST(Contact, EachPillarIsTheIntegralOfTheTextbookTraction) {
  constexpr std::uint32_t kPillars = 12;
  for (ClosedFormContact contact : all_kinds()) {
    for (const double radius : {0.4, 2.9}) {
      contact.contact_radius_mm = radius;
      SCOPED_TRACE(kind_of(contact));
      const ContactKey& state = contact.path.front();
      const ForceField field = field_of(contact, kPillars);
      for (std::uint32_t r = 3; r < 8; ++r) {
        for (std::uint32_t c = 4; c < 8; ++c) {
          const double x0 = (c - kPillars / 2.0) * kPitch;
          const double y1 = (kPillars / 2.0 - r) * kPitch;
          const auto force =
              oracle::force_on_cell(contact, state, {x0, x0 + kPitch, y1 - kPitch, y1});
          const std::size_t i = std::size_t{r} * kPillars + c;
          const double tolerance = 3e-7 * state.load_n;
          EXPECT_NEAR(double{field.normal[i]}, force.pressure, tolerance) << r << ", " << c;
          EXPECT_NEAR(double{field.shear_x[i]}, force.x, tolerance) << r << ", " << c;
          EXPECT_NEAR(double{field.shear_y[i]}, force.y, tolerance) << r << ", " << c;
        }
      }
    }
  }
}

/// Moments converge with the square of the pitch where the traction is bounded.
double torque_of(const ClosedFormContact& contact, double pitch) {
  const auto pillars = static_cast<std::uint32_t>(2 * std::ceil(9 / pitch));
  return resultant_of(field_of(contact, pillars, pitch), pitch).torque;
}

TEST(Contact, SpinHasTheTorqueOfTheClosedForm) {
  ClosedFormContact contact;
  contact.motion = ContactMotion::spin;
  contact.contact_radius_mm = 8;
  contact.reference_load_n = 3;
  contact.friction = 0.5;
  contact.path = {{0, 0, 0, 3}};
  const double sphere = 3 * pi / 16 * 0.5 * 3 * 8;
  EXPECT_NEAR(torque_of(contact, 0.05), sphere, 2e-5 * sphere);
  contact.clockwise = true;
  EXPECT_NEAR(torque_of(contact, 0.05), -sphere, 2e-5 * sphere);
  contact.shape = ContactShape::flat_punch;
  const double punch = -pi / 4 * 0.5 * 3 * 8;
  EXPECT_NEAR(torque_of(contact, 0.05), punch, 5e-5 * -punch);
}

TEST(Contact, TheRadiusFollowsTheLoad) {
  ClosedFormContact contact;
  contact.contact_radius_mm = 3;
  contact.reference_load_n = 2;
  EXPECT_DOUBLE_EQ(contact_radius_mm(contact, 16), 6);
  contact.shape = ContactShape::cylinder;
  EXPECT_DOUBLE_EQ(contact_radius_mm(contact, 8), 6);
  contact.shape = ContactShape::flat_punch;
  EXPECT_DOUBLE_EQ(contact_radius_mm(contact, 8), 3);
}

TEST(Contact, WhatLiesOutsideThePatchIsLost) {
  for (ClosedFormContact contact : all_kinds()) {
    contact.path = {{0, 4 * kPitch, -3 * kPitch, 1}};
    SCOPED_TRACE(kind_of(contact));
    const ForceField small = field_of(contact, 8);
    const ForceField large = field_of(contact, 32);
    for (std::uint32_t r = 0; r < 8; ++r) {
      for (std::uint32_t c = 0; c < 8; ++c) {
        EXPECT_NEAR(small.normal[r * 8 + c], large.normal[(r + 12) * 32 + c + 12], 1e-7F);
        EXPECT_NEAR(small.shear_x[r * 8 + c], large.shear_x[(r + 12) * 32 + c + 12], 1e-7F);
      }
    }
    contact.path = {{0, 1e6, -1e6, 1}};
    EXPECT_EQ(resultant_of(field_of(contact, 8), kPitch).normal, 0);
  }
}

TEST(Contact, NothingIsFeltOutsideTheContactOrWithoutLoad) {
  for (ClosedFormContact contact : all_kinds()) {
    SCOPED_TRACE(kind_of(contact));
    const ForceField field = field_of(contact, 40);
    EXPECT_EQ(field.normal[0], 0);
    EXPECT_EQ(field.shear_x[0], 0);
    contact.path.front().load_n = 0;
    EXPECT_EQ(resultant_of(field_of(contact, 40), kPitch).normal, 0);
    contact.path.front().load_n = 1e-300;
    EXPECT_TRUE(std::isfinite(resultant_of(field_of(contact, 40), kPitch).torque));
  }
}

TEST(Contact, APathIsLinearBetweenKeysAndConstantBeyond) {
  ClosedFormContact contact;
  contact.path = {{1, 0, 10, 2}, {3, 4, 0, 6}, {4, 4, 0, 0}};
  EXPECT_DOUBLE_EQ(state_at(contact, 0).load_n, 2);
  EXPECT_DOUBLE_EQ(state_at(contact, 1).y_mm, 10);
  EXPECT_DOUBLE_EQ(state_at(contact, 1.5).x_mm, 1);
  EXPECT_DOUBLE_EQ(state_at(contact, 1.5).y_mm, 7.5);
  EXPECT_DOUBLE_EQ(state_at(contact, 1.5).load_n, 3);
  EXPECT_DOUBLE_EQ(state_at(contact, 3).load_n, 6);
  EXPECT_DOUBLE_EQ(state_at(contact, 3.75).load_n, 1.5);
  EXPECT_DOUBLE_EQ(state_at(contact, 9).load_n, 0);
}

}  // namespace
}  // namespace pillarfield
