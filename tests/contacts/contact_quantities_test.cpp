#include "pillarfield/contact_quantities.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <vector>

#include "pillarfield/contact_tracker.h"
#include "pillarfield/status.h"

namespace pillarfield {
namespace {

constexpr double kPitchMm = 1.25;

void load(ForceField& field, std::uint32_t row, std::uint32_t col, float shear_x, float shear_y,
          float normal, std::uint8_t status = status::kUsable) {
  const std::size_t place = std::size_t{row} * field.cols + col;
  field.shear_x[place] = shear_x;
  field.shear_y[place] = shear_y;
  field.normal[place] = normal;
  field.status[place] = status;
}

ContactQuantities only_contact(const ForceField& field, const ContactOptions& options = {}) {
  ContactTracker tracker(kPitchMm, options);
  const FrameContacts& frame = tracker.update(field.view(), 0);
  EXPECT_EQ(frame.contacts.size(), 1);
  return frame.contacts.empty() ? ContactQuantities() : frame.contacts[0].quantities;
}

TEST(ContactQuantities, OfAFewPillarsAreThoseByHand) {
  ForceField field(4, 6);  // x of columns: -3.125 ... 3.125 mm, y of rows: 1.875 ... -1.875 mm
  load(field, 0, 3, 0.5F, 0, 1);
  load(field, 0, 4, 0, 0.25F, 3, status::kUsable | status::kSaturated);  // It counts.
  load(field, 1, 5, 0, -0.5F, 4, status::kUsable | status::kAmbiguous);
  const ContactQuantities contact = only_contact(field);
  EXPECT_EQ(contact.pillars, 3);
  EXPECT_EQ(contact.ambiguous, 1);
  EXPECT_EQ(contact.resolved, 0);
  EXPECT_DOUBLE_EQ(contact.shear_x_n, 0.5);
  EXPECT_DOUBLE_EQ(contact.shear_y_n, -0.25);
  EXPECT_DOUBLE_EQ(contact.normal_n, 8);
  EXPECT_DOUBLE_EQ(contact.centre.x_mm, (0.625 + 1.875 + 3.125) / 3);
  EXPECT_DOUBLE_EQ(contact.centre.y_mm, (1.875 + 1.875 + 0.625) / 3);
  const double x = (1 * 0.625 + 3 * 1.875 + 4 * 3.125) / 8;
  const double y = (4 * 1.875 + 4 * 0.625) / 8;
  EXPECT_DOUBLE_EQ(contact.centre_of_pressure.x_mm, x);
  EXPECT_DOUBLE_EQ(contact.centre_of_pressure.y_mm, y);
  const double torque = (1.875 - x) * 0.25 + (3.125 - x) * -0.5 - (1.875 - y) * 0.5;
  EXPECT_NEAR(contact.torque_nmm, torque, 1e-14);
  EXPECT_DOUBLE_EQ(contact.area_mm2, 3 * kPitchMm * kPitchMm);
  EXPECT_DOUBLE_EQ(contact.peak_n, 4);
  EXPECT_DOUBLE_EQ(contact.peak.x_mm, 3.125);
  EXPECT_DOUBLE_EQ(contact.peak.y_mm, 0.625);
  EXPECT_DOUBLE_EQ(contact.mean_pressure_kpa, 1000 * 8 / contact.area_mm2);
}

/// The moment about a point is the sum over pillars of r × F, wherever the point is.
TEST(ContactQuantities, MomentMovesToAnyPoint) {
  ForceField field(5, 5);
  for (std::uint32_t i = 0; i < 25; ++i) {
    const auto n = static_cast<float>(i);
    load(field, i / 5, i % 5, 0.1F * n - 1, 0.7F - 0.05F * n, 1 + 0.3F * n);
  }
  const ContactQuantities contact = only_contact(field);
  for (const PatchPlace point : {PatchPlace{0, 0}, {7, -3}, contact.centre_of_pressure}) {
    Moment expected;
    for (std::uint32_t i = 0; i < 25; ++i) {
      const auto row = static_cast<int>(i / 5);
      const auto col = static_cast<int>(i % 5);
      const double x = (col - 2) * kPitchMm - point.x_mm;
      const double y = (2 - row) * kPitchMm - point.y_mm;
      const auto place = std::size_t{i};
      expected.x_nmm += y * -double{field.normal[place]};
      expected.y_nmm -= x * -double{field.normal[place]};
      expected.z_nmm += x * double{field.shear_y[place]} - y * double{field.shear_x[place]};
    }
    const Moment moment = moment_about(point, contact);
    EXPECT_NEAR(moment.x_nmm, expected.x_nmm, 1e-4);
    EXPECT_NEAR(moment.y_nmm, expected.y_nmm, 1e-4);
    EXPECT_NEAR(moment.z_nmm, expected.z_nmm, 1e-4);
  }
}

TEST(ContactQuantities, WithoutPressureTheCentreOfPressureIsTheCentre) {
  ForceField field(3, 3);
  load(field, 0, 0, 1, 0, 0);
  load(field, 1, 1, 1, 0, -0.5F);
  const ContactQuantities contact = only_contact(field, {.friction = {.given = 0.5}});
  EXPECT_EQ(contact.centre_of_pressure.x_mm, contact.centre.x_mm);
  EXPECT_EQ(contact.centre_of_pressure.y_mm, contact.centre.y_mm);
  EXPECT_EQ(contact.slip, SlipState::unknown);
  EXPECT_FALSE(contact.slip_margin || contact.slipping_share);
}

TEST(ContactQuantities, TakeAnyForce) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  ForceField field(6, 6);
  std::uint32_t place = 0;
  for (const float force : {kNan, kInfinity, -kInfinity, 3e38F, -3e38F, 1e-40F}) {
    for (std::uint32_t col = 0; col < 6; ++col) {
      load(field, place, col, col % 2 == 0 ? force : 1, col % 3 == 0 ? force : 1,
           col < 4 ? force : 1, static_cast<std::uint8_t>(place * 41 + col * 7 + 1));
    }
    ++place;
  }
  for (const auto& friction : {std::optional<double>(), std::optional(0.5)}) {
    ContactTracker tracker(kPitchMm, {.friction = {.given = friction}});
    for (int i = 0; i < 2; ++i) {
      const FrameContacts& frame = tracker.update(field.view(), i);
      EXPECT_TRUE(std::isfinite(frame.total.normal_n));
      EXPECT_TRUE(std::isfinite(frame.total.torque_nmm));
      EXPECT_TRUE(std::isfinite(frame.total.centre_of_pressure.x_mm));
    }
  }
}

TEST(ContactQuantities, PatchHasWhatSmallContactsBear) {
  ForceField field(9, 9);
  load(field, 0, 0, 1, 2, 3);
  for (std::uint32_t col = 3; col < 6; ++col) load(field, 5, col, 0, 0, 1);
  ContactTracker tracker(kPitchMm, {.minimum_pillars = 2});
  const FrameContacts& frame = tracker.update(field.view(), 0);
  ASSERT_EQ(frame.contacts.size(), 1);
  EXPECT_EQ(frame.contacts[0].quantities.normal_n, 3);
  EXPECT_EQ(frame.contacts[0].label, 1);
  EXPECT_EQ(frame.total.normal_n, 6);
  EXPECT_EQ(frame.total.pillars, 4);
  EXPECT_EQ(tracker.labels().contacts(), 2);
}

/// A band of `slipping` pillars of ratio 0.5, `sticking` ones of ratio 0.1 and `undetermined`
/// ambiguous ones.
ContactQuantities band(int slipping, int sticking, int undetermined,
                       std::optional<double> friction) {
  ForceField field(1, static_cast<std::uint32_t>(slipping + sticking + undetermined));
  for (std::uint32_t col = 0; col < field.cols; ++col) {
    const int i = static_cast<int>(col);
    const bool slips = i < slipping;
    const bool is_open = i >= slipping + sticking;
    load(field, 0, col, slips ? 0.5F : 0.1F, 0, 1,
         is_open ? status::kSensel1 | status::kSensel2 | status::kAmbiguous : status::kUsable);
  }
  return only_contact(field, {.friction = {.given = friction}});
}

TEST(Slip, StateGoesByTheShareThatSlips) {
  using enum SlipState;
  EXPECT_EQ(band(0, 100, 0, 0.5).slip, sticking);
  EXPECT_EQ(band(10, 90, 0, 0.5).slip, sticking);
  EXPECT_EQ(band(11, 89, 0, 0.5).slip, partial);
  EXPECT_EQ(band(89, 11, 0, 0.5).slip, partial);
  EXPECT_EQ(band(90, 10, 0, 0.5).slip, sliding);
  EXPECT_EQ(band(100, 0, 0, 0.5).slip, sliding);
  EXPECT_DOUBLE_EQ(*band(30, 70, 0, 0.5).slipping_share, 0.3);
}

TEST(Slip, APillarSlipsFromNineTenthsOfTheFrictionOn) {
  EXPECT_EQ(band(100, 0, 0, 0.5 / 0.93).slip, SlipState::sliding);
  EXPECT_EQ(band(100, 0, 0, 0.5 / 0.91).slip, SlipState::sticking);
}

TEST(Slip, PillarsLeftOpenMayMakeItUnknown) {
  using enum SlipState;
  EXPECT_EQ(band(0, 91, 9, 0.5).slip, sticking);
  EXPECT_EQ(band(0, 80, 20, 0.5).slip, unknown);  // the undetermined ones may slip
  EXPECT_EQ(band(90, 0, 10, 0.5).slip, sliding);
  EXPECT_EQ(band(80, 0, 20, 0.5).slip, unknown);  // some of them may stick
  EXPECT_EQ(band(70, 0, 30, 0.5).slip, unknown);
  EXPECT_EQ(band(30, 30, 40, 0.5).slip, partial);
  EXPECT_EQ(band(0, 0, 10, 0.5).slip, unknown);
  EXPECT_DOUBLE_EQ(*band(30, 30, 40, 0.5).slipping_share, 0.5);
  EXPECT_FALSE(band(0, 0, 10, 0.5).slipping_share);
}

/// The least friction that it may have still holds it.
TEST(Slip, APressedContactSticksWhateverItsFriction) {
  const ContactQuantities contact = band(0, 100, 0, std::nullopt);
  EXPECT_EQ(contact.slip, SlipState::sticking);
  EXPECT_EQ(contact.friction_source, FrictionSource::prior);
  EXPECT_FALSE(contact.slip_margin || contact.slipping_share);
}

/// The friction of its roughest part tells its pillars, not the lower bound of the whole.
TEST(Slip, ABoundedContactSticksIfFewPillarsComeNearItsLargestRatios) {
  for (const double most : {0.69, 0.79}) {
    ForceField field(12, 12);
    for (std::uint32_t i = 0; i < 100; ++i) {
      const double ratio = i % 12 == 0 ? 0.8 : 0.25 + (most - 0.25) * i / 100;
      load(field, 1 + i / 10, 1 + i % 10, static_cast<float>(ratio), 0, 1);
    }
    const ContactQuantities contact = only_contact(field);
    EXPECT_EQ(contact.friction_source, FrictionSource::at_least) << most;
    EXPECT_EQ(contact.slip, most < 0.7 ? SlipState::sticking : SlipState::unknown) << most;
  }
}

/// Pillars whose noise reaches from the friction to their ratio may slip.
TEST(Slip, NoisyPillarsMayMakeItUnknown) {
  ForceField field(1, 100);
  for (std::uint32_t col = 0; col < 100; ++col) load(field, 0, col, 0.5F, 0, 1);
  const auto state = [&](double noise_n) {
    return only_contact(field, {.friction = {.given = 0.6}, .noise_n = noise_n}).slip;
  };
  EXPECT_EQ(state(0.05), SlipState::sticking);
  EXPECT_EQ(state(0.07), SlipState::unknown);
}

TEST(Slip, MarginIsOfTheSums) {
  const ContactQuantities contact = band(50, 50, 0, 0.5);
  EXPECT_NEAR(*contact.slip_margin, 1 - 0.3 / 0.5, 1e-6);
  EXPECT_EQ(contact.friction_source, FrictionSource::given);
  EXPECT_NEAR(*band(100, 0, 0, 0.4).slip_margin, 1 - 0.5 / 0.4, 1e-6);  // beyond the friction
}

TEST(Slip, IsForetoldFromTheFourthFrameOfATrack) {
  ContactTracker tracker(kPitchMm, {.friction = {.given = 0.5}});
  for (int frame = 0; frame < 5; ++frame) {
    ForceField field(1, 100);
    for (std::uint32_t col = 0; col < 100; ++col) {
      load(field, 0, col, 0.1F + 0.02F * static_cast<float>(frame), 0, 1);
    }
    const auto& contacts = tracker.update(field.view(), 0.1 * frame).contacts;
    const auto& found = contacts.at(0).quantities.slip_forecast;
    ASSERT_EQ(found.has_value(), frame >= 3) << frame;
    if (!found) continue;
    EXPECT_NEAR(found->time_s.value(), (0.4 - 0.02 * frame) / 0.2, 1e-3);
  }
}

/// Forces above a threshold of four deviations: 15 specks of noise in 480,000, and a real contact.
TEST(Contacts, OfOnePillarNeedFiveDeviationsOfNoise) {
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0, 1);
  std::map<bool, std::size_t> found;
  for (int frame = 0; frame < 400; ++frame) {
    ForceField field(40, 60);
    for (std::uint32_t i = 0; i < 2400; ++i) {
      const float reading = noise(random) + (i == 1234 && frame % 2 == 0 ? 9.0F : 0);
      if (reading >= 4) load(field, i / 60, i % 60, 0, 0, reading);
    }
    ContactTracker tracker(kPitchMm, {.noise_n = 1});
    found[frame % 2 == 0] += tracker.update(field.view(), 0).contacts.size();
  }
  EXPECT_LE(found[false], 1U);
  EXPECT_NEAR(static_cast<double>(found[true]), 200, 1);
}

/// A contact that slides or spins slips now, from its first frame on.
TEST(Slip, IsNowWhereTheContactSlides) {
  ContactTracker tracker(kPitchMm, {.friction = {.given = 0.5}});
  for (int frame = 0; frame < 12; ++frame) {
    ForceField field(3, 100);
    for (std::uint32_t col = 0; col < 100; ++col) {
      // Its ratio swings, and falls for a while, as that of the sliding bodies of demo.toml does.
      load(field, 0, col, 0.48F + 0.02F * std::sin(static_cast<float>(frame)), 0, 1);
      load(field, 2, col, 0, col < 50 ? 0.5F : -0.5F, 1);
    }
    const auto& contacts = tracker.update(field.view(), 0.01 * frame).contacts;
    ASSERT_EQ(contacts.size(), 2U);
    for (const TrackedContact& contact : contacts) {
      EXPECT_EQ(contact.quantities.slip, SlipState::sliding);
      const auto& forecast = contact.quantities.slip_forecast;
      ASSERT_TRUE(forecast) << frame;
      EXPECT_EQ(forecast->time_s, 0);
      EXPECT_EQ(forecast->low_s, 0);
      EXPECT_EQ(forecast->high_s, 0);
      EXPECT_EQ(forecast->probability, (std::array<double, 3>{1, 1, 1}));
    }
  }
}

/// Force of a pillar over that of the middle under a rounded body.
double rounded(std::uint32_t i, std::uint32_t count) {
  const double place = (2.0 * i + 1) / count - 1;
  return std::sqrt(1.0001 - place * place);
}

/// A contact of `rows` x `cols` pillars under a rounded body. A seventh of the pillars sticks; the
/// others slip in various directions, with a little noise. The friction varies by `variation`.
ForceField mostly_sliding(std::uint32_t rows, std::uint32_t cols, double friction,
                          double variation = 0) {
  ForceField field(rows + 2, cols + 2);
  for (std::uint32_t i = 0; i < rows * cols; ++i) {
    const std::uint32_t row = i / cols;
    const std::uint32_t col = i % cols;
    const double normal = rounded(row, rows) * rounded(col, cols);
    const double direction = 0.1 * i;
    const double noise = 1 + 0.02 * std::sin(1.7 * i) + variation * std::sin(0.6 * col);
    const bool sticks = i * 2654435761U % 7 == 0;
    const double shear = normal * (sticks ? 0.3 * friction : friction * noise);
    load(field, row + 1, col + 1, static_cast<float>(shear * std::cos(direction)),
         static_cast<float>(shear * std::sin(direction)), static_cast<float>(normal));
  }
  return field;
}

/// A face of uniform pressure on a hundred pillars: some at one ratio, the others at another.
ForceField face(int first, double first_ratio, double other_ratio) {
  ForceField field(12, 12);
  for (std::uint32_t i = 0; i < 100; ++i) {
    const double ratio = static_cast<int>(i) < first ? first_ratio : other_ratio;
    load(field, 1 + i / 10, 1 + i % 10, static_cast<float>(ratio), 0, 1);
  }
  return field;
}

TEST(Friction, OfARoundedBodyIsObservedAndCarriedOver) {
  ContactTracker tracker(kPitchMm);
  const auto update = [&](double friction) {
    return tracker.update(mostly_sliding(14, 16, friction).view(), 0).contacts.at(0).quantities;
  };
  EXPECT_EQ(update(0).slip, SlipState::sticking);
  const ContactQuantities slid = update(0.7);
  EXPECT_EQ(slid.friction_source, FrictionSource::observed);
  EXPECT_NEAR(*slid.friction, 0.7, 0.02);
  EXPECT_GT(*slid.friction_deviation, 0);
  EXPECT_LT(*slid.friction_deviation, 0.05 * 0.7);
  const ContactQuantities stuck = update(0.1);
  EXPECT_EQ(stuck.slip, SlipState::sticking);
  EXPECT_EQ(stuck.friction_source, FrictionSource::carried_over);
  EXPECT_NEAR(*stuck.friction, 0.7, 0.02);
}

/// After unloading, pillars that stick at smaller ratios say nothing; of a contact that slides they
/// contradict the friction last shown.
TEST(Friction, IsContradictedBySmallerRatiosOnlyOfAContactThatSlides) {
  for (const int others : {40, 5}) {
    ContactTracker tracker(kPitchMm);
    const auto update = [&](const ForceField& field) {
      return tracker.update(field.view(), 0).contacts.at(0).quantities;
    };
    ASSERT_EQ(update(mostly_sliding(10, 10, 0.7)).friction_source, FrictionSource::observed);
    ContactQuantities contact;
    for (int i = 0; i < 2; ++i) contact = update(face(100 - others, 0.55, 0.25));
    if (others == 40) {
      EXPECT_EQ(contact.friction_source, FrictionSource::carried_over);
      EXPECT_NEAR(contact.friction.value(), 0.7, 0.02);
    } else {
      EXPECT_EQ(contact.friction_source, FrictionSource::at_least);
      EXPECT_LT(contact.friction.value(), 0.55);
    }
  }
}

TEST(Friction, OfAnUnevenBodyHasADeviationThatSaysSo) {
  double narrower = 0;
  for (const double variation : {0.0, 0.1}) {
    const ContactQuantities contact = only_contact(mostly_sliding(20, 24, 0.7, variation));
    ASSERT_TRUE(contact.friction_deviation) << variation;
    EXPECT_NEAR(*contact.friction, 0.7, 1.96 * *contact.friction_deviation) << variation;
    EXPECT_GT(*contact.friction_deviation, 1.3 * narrower) << variation;
    EXPECT_LT(*contact.friction_deviation, 0.03 + 0.7 * variation) << variation;
    narrower = *contact.friction_deviation;
  }
}

TEST(Friction, WithoutMemoryIsNotCarriedOver) {
  ContactTracker tracker(kPitchMm, {.friction = {.memory = false}});
  tracker.update(mostly_sliding(14, 16, 0.7).view(), 0);
  const FrameContacts& stuck = tracker.update(mostly_sliding(14, 16, 0.1).view(), 1);
  EXPECT_EQ(stuck.contacts.at(0).quantities.friction_source, FrictionSource::prior);
}

/// The contact moves by 15 pillars (19 mm).
ForceField moved(const ForceField& field) {
  ForceField wide(field.rows, field.cols + 30);
  for (std::size_t i = 0; i < field.elements(); ++i) {
    load(wide, static_cast<std::uint32_t>(i / field.cols),
         static_cast<std::uint32_t>(15 + i % field.cols), field.shear_x[i], field.shear_y[i],
         field.normal[i], field.status[i]);
  }
  return wide;
}

TEST(Friction, IsCarriedOverAsFarAsAContactMayJump) {
  for (const double reach_mm : {5.0, 50.0}) {
    ContactTracker tracker(kPitchMm, {.reach_mm = reach_mm});
    ForceField first = moved(mostly_sliding(12, 12, 0.7));
    for (auto* plane : {&first.shear_x, &first.shear_y, &first.normal}) {
      std::rotate(plane->begin(), plane->begin() + 15, plane->end());
    }
    std::rotate(first.status.begin(), first.status.begin() + 15, first.status.end());
    tracker.update(first.view(), 0);
    const ForceField second = moved(mostly_sliding(12, 12, 0.1));
    const FrameContacts& frame = tracker.update(second.view(), 1);
    EXPECT_EQ(frame.contacts.at(0).quantities.friction_source,
              reach_mm < 19 ? FrictionSource::prior : FrictionSource::carried_over);
  }
}

/// A sticking punch: all pillars share one ratio, which grows with the shear: a lower bound of the
/// friction. Losing the shear again proves nothing.
TEST(Friction, OfAFaceThatMayStickIsBoundedFromBelow) {
  for (const std::vector<double>& ratios :
       {std::vector{0.3, 0.4, 0.55, 0.55, 0.7}, std::vector{0.4, 0.4, 0.0, 0.1, 0.3, 0.25, 0.0}}) {
    ContactTracker tracker(kPitchMm);
    for (const double ratio : ratios) {
      const FrameContacts& frame = tracker.update(face(100, ratio, 0).view(), 0);
      const ContactQuantities& contact = frame.contacts.at(0).quantities;
      EXPECT_NE(contact.slip, SlipState::sliding) << ratio;
      if (ratio == std::ranges::max(ratios)) {
        EXPECT_EQ(contact.slip, SlipState::unknown);
      }
      EXPECT_EQ(contact.friction_source, FrictionSource::at_least) << ratio;
      EXPECT_LT(contact.friction.value(), std::ranges::max(ratios)) << ratio;
      EXPECT_FALSE(contact.friction_deviation || contact.slip_margin || contact.slipping_share);
      EXPECT_FALSE(contact.slip_forecast) << ratio;
    }
  }
}

/// A sticking stamp, whose edge bears little and slips at larger ratios.
TEST(Friction, OfAStampWhoseEdgeAloneSlipsIsBoundedFromBelow) {
  ForceField field = mostly_sliding(12, 12, 0.5);
  for (std::uint32_t i = 0; i < field.elements(); ++i) {
    if (!(field.normal[i] > 0)) continue;
    field.shear_x[i] = field.normal[i] * (i % 19 == 0 ? 0.8F : 0.5F);
    field.shear_y[i] = 0;
  }
  const ContactQuantities contact = only_contact(field);
  EXPECT_EQ(contact.friction_source, FrictionSource::at_least);
  EXPECT_LT(contact.friction.value(), 0.5);
}

TEST(Friction, OfAFaceIsReportedOnceItStayedWhileOtherPillarsWereLoaded) {
  ContactTracker tracker(kPitchMm);
  const auto update = [&](double other_ratio) {
    return tracker.update(face(40, 0.8, other_ratio).view(), 0).contacts.at(0).quantities;
  };
  EXPECT_EQ(update(0.25).friction_source, FrictionSource::at_least);
  update(0.4);
  const ContactQuantities later = update(0.6);
  EXPECT_EQ(later.friction_source, FrictionSource::observed);
  EXPECT_NEAR(*later.friction, 0.8, 0.02);
  EXPECT_EQ(later.slip, SlipState::partial);
}

TEST(Friction, IsNeverBelowARatioThatWasSurelySeen) {
  ContactTracker tracker(kPitchMm);
  for (const double friction : {0.5, 0.6, 0.9, 1.2, 0.8, 1.6}) {
    const FrameContacts& frame = tracker.update(mostly_sliding(20, 20, friction).view(), 0);
    const ContactQuantities& contact = frame.contacts.at(0).quantities;
    ASSERT_TRUE(contact.friction) << friction;
    EXPECT_GT(*contact.friction, 0.97 * friction);
  }
}

/// Large contacts are sampled: the friction agrees within a tenth of a pillar's noise.
TEST(Friction, OfALargeContactIsSeenInSomeOfItsPillars) {
  for (const auto& [rows, cols] :
       {std::pair{10U, 10U}, {30U, 33U}, {30U, 34U}, {63U, 64U}, {200U, 210U}, {300U, 9U}}) {
    const ContactQuantities contact = only_contact(mostly_sliding(rows, cols, 0.7));
    ASSERT_TRUE(contact.friction.has_value()) << rows << " x " << cols;
    EXPECT_NEAR(*contact.friction, 0.7, 0.02) << rows << " x " << cols;
    EXPECT_EQ(contact.friction_source, FrictionSource::observed);
    // Slip is summed over all pillars.
    EXPECT_NEAR(*contact.slipping_share, 6.0 / 7, 0.03) << rows << " x " << cols;
  }
}

}  // namespace
}  // namespace pillarfield
