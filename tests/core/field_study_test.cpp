#include "field_study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>

#include "core/contact_traction.h"
#include "core/pillar_maths.h"
#include "field_study_twins.h"
#include "pillarfield/status.h"

namespace pillarfield::field_study {
namespace {

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Shapes at a radius at which a pillar is not small, off the centre of the skin.
FieldContact contact_of(Shape shape) {
  FieldContact contact;
  contact.body.shape = shape;
  contact.body.radius = 14;
  contact.body.second = 0.5;
  contact.body.aspect = shape == Shape::ellipse ? 0.6 : 1.2;
  contact.body.angle_deg = 30;
  contact.body.x = 0.3;
  contact.body.y = -0.2;
  return contact;
}

/// The load in units of the pressure that pressure_at has, times the radius squared.
double closed_load(Shape shape) {
  constexpr double kPi = std::numbers::pi;
  switch (shape) {
    case Shape::sphere:
      return 2 * kPi / 3;
    case Shape::ellipse:
      return 0.6 * 2 * kPi / 3;
    case Shape::paraboloid:
      return kPi / 2;
    case Shape::two_spheres:
    case Shape::merged_spheres:  // which do not meet at that distance
      return 2 * kPi / 3 * (1 + std::pow(0.5, 3));
    case Shape::wavy:
      return 2 * kPi / 3;  // without a ripple
    case Shape::cylinder:
      return kPi / 2 * 2 * 1.2;
    case Shape::cone:
      return kPi;
    case Shape::truncated_cone:
      return kPi * (1 - std::pow(0.5, 2));
    case Shape::punch:
      return 2 * kPi;
    case Shape::blunt:
      return 0.5 * 2 * kPi / 3 + 0.5 * 2 * kPi / 5;
    case Shape::rounded_punch:
      break;
  }
  return 2 * kPi / 3 * (1 - std::pow(0.5, 3));
}

class OfEachShape : public testing::TestWithParam<Shape> {};

TEST_P(OfEachShape, ForcesSumToTheLoad) {
  const FieldContact contact = contact_of(GetParam());
  const PillarLoads loads = loads_of(contact);
  const double radius = contact.body.radius;
  const double load = closed_load(GetParam()) * radius * radius * loads.counts_per_pressure;
  EXPECT_NEAR(sum(loads.normal) / load, 1, GetParam() == Shape::punch ? 1e-2 : 1e-4);
  EXPECT_DOUBLE_EQ(*std::max_element(loads.normal.begin(), loads.normal.end()), 100);
}

TEST_P(OfEachShape, NoTractionExceedsFriction) {
  for (const Motion motion : {Motion::partial_slip, Motion::slide, Motion::spin, Motion::turn,
                              Motion::partial_turn, Motion::roll}) {
    FieldContact contact = contact_of(GetParam());
    contact.body.second = 0.3;
    contact.drive = {.motion = motion, .load_ratio = 0.7, .pivot_x = 0.2};
    const bool rolls = family_of(GetParam()) == Family::rounded &&
                       GetParam() != Shape::paraboloid && GetParam() != Shape::two_spheres &&
                       GetParam() != Shape::merged_spheres;
    if (motion == Motion::roll && !rolls) continue;
    for (int i = -28; i <= 28; ++i) {
      for (int j = -28; j <= 28; ++j) {
        const Traction at = traction_at(contact, 0.0701 * i, 0.0701 * j);
        ASSERT_GE(at.pressure, 0);
        ASSERT_LE(std::hypot(at.x, at.y), at.pressure * (1 + 1e-12)) << name_of(motion);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(FieldContacts, OfEachShape,
                         testing::Values(Shape::sphere, Shape::ellipse, Shape::paraboloid,
                                         Shape::two_spheres, Shape::merged_spheres, Shape::wavy,
                                         Shape::cylinder, Shape::cone, Shape::truncated_cone,
                                         Shape::punch, Shape::rounded_punch, Shape::blunt));

/// The drag is the share of what friction can bear that the scene names.
TEST(FieldContacts, DragByTheirLoadRatio) {
  for (const Shape shape :
       {Shape::sphere, Shape::ellipse, Shape::paraboloid, Shape::cylinder, Shape::cone,
        Shape::truncated_cone, Shape::rounded_punch, Shape::blunt}) {
    FieldContact contact = contact_of(shape);
    contact.body.second = 0.3;
    contact.drive = {.motion = Motion::partial_slip, .direction_deg = 20, .load_ratio = 0.8};
    const PillarLoads loads = loads_of(contact);
    const double drag = std::hypot(sum(loads.shear_x), sum(loads.shear_y));
    EXPECT_NEAR(drag / sum(loads.normal), 0.8, 1e-3) << name_of(shape);
  }
}

/// What the simulator makes of the same contact, in counts and for friction 1: other mathematics,
/// corner functions instead of points.
ForceField simulated(const FieldContact& contact, const PillarLoads& loads) {
  const std::map<Motion, ContactMotion> motions = {
      {Motion::press, ContactMotion::press},
      {Motion::slide, ContactMotion::slide},
      {Motion::partial_slip, ContactMotion::partial_slip},
      {Motion::spin, ContactMotion::spin},
      {Motion::roll, ContactMotion::roll}};
  const Body& body = contact.body;
  Contact made;
  made.motion = motions.at(contact.drive.motion);
  made.direction_deg = contact.drive.direction_deg;
  if (body.shape == Shape::punch) made.shape = ContactShape::flat_punch;
  if (body.shape == Shape::cylinder) {
    made.shape = ContactShape::cylinder;
    made.direction_deg = body.angle_deg;
  }
  made.contact_radius_mm = body.radius;
  made.reference_load_n = sum(loads.normal);
  made.length_mm = 2 * body.aspect * body.radius;
  made.friction = 1;
  made.tangential_ratio = contact.drive.load_ratio;
  ForceField forces(loads.rows, loads.cols);
  add_contact(made, {0, body.x, body.y, made.reference_load_n}, 1, forces);
  return forces;
}

TEST(FieldContacts, AreThoseOfTheSimulator) {
  const std::vector<std::pair<Shape, Motion>> cases = {
      {Shape::sphere, Motion::press},   {Shape::sphere, Motion::slide},
      {Shape::sphere, Motion::spin},    {Shape::sphere, Motion::partial_slip},
      {Shape::cylinder, Motion::press}, {Shape::cylinder, Motion::roll},
      {Shape::punch, Motion::slide},    {Shape::punch, Motion::spin}};
  for (const auto& [shape, motion] : cases) {
    SCOPED_TRACE(std::string(name_of(shape)) + ", " + name_of(motion));
    FieldContact contact = contact_of(shape);
    if (shape != Shape::cylinder) contact.body.angle_deg = 0;
    contact.drive = {.motion = motion, .direction_deg = 70, .load_ratio = 0.6};
    const PillarLoads loads = loads_of(contact);
    const ForceField forces = simulated(contact, loads);
    // Of 100 counts; at the edge of a punch the pressure has no end.
    const double doubt = std::map<Shape, double>{
        {Shape::sphere, 0.03},
        {Shape::cylinder, 0.2},
        {Shape::punch, 2}}.at(shape);
    for (std::size_t i = 0; i < forces.pillars(); ++i) {
      ASSERT_NEAR(loads.normal[i], forces.normal[i], doubt);
      ASSERT_NEAR(loads.shear_x[i], forces.shear_x[i], doubt);
      ASSERT_NEAR(loads.shear_y[i], forces.shear_y[i], doubt);
    }
  }
}

TEST(FieldContacts, SphereBearsItsPressureInTheMiddle) {
  FieldContact contact = contact_of(Shape::sphere);
  contact.drive = {.motion = Motion::slide, .direction_deg = 90};
  const PillarLoads loads = loads_of(contact);
  const std::size_t middle = std::size_t{loads.rows / 2} * loads.cols + loads.cols / 2;
  EXPECT_NEAR(loads.normal[middle], 100, 0.5);
  EXPECT_NEAR(loads.shear_y[middle], loads.normal[middle], 1e-6);
  EXPECT_NEAR(loads.shear_x[middle], 0, 1e-6);
}

/// A spinning sphere and one in partial slip, of tuning, with the middle noise.
std::vector<Scene> few_scenes() {
  std::vector<Scene> scenes = tuning("sphere 14, spin, mu 2.3, noise 0.5");
  const auto more = tuning("sphere 14, partial slip 0.93");
  scenes.insert(scenes.end(), more.begin(), more.begin() + 2);
  integrate(scenes);
  return scenes;
}

TEST(FieldStudy, SegmentsExplainTheReadings) {
  for (const Scene& scene : few_scenes()) {
    const Observed observed(scene);
    const auto raw = observed.frame().readings<float>();
    const std::size_t width = 2 * std::size_t{observed.direct().cols};
    ASSERT_GT(observed.open().size(), 50);
    for (const std::size_t i : observed.open()) {
      const Segment segment = segment_of(observed.direct(), i);
      const std::size_t top = 2 * (i / observed.direct().cols) * width;
      const std::size_t left = 2 * (i % observed.direct().cols);
      for (const double share : {0.0, 0.3, 1.0}) {
        const double normal = share * segment.normal_high;
        const auto v = double_precision::model_readings(
            {segment.shear_x(normal), segment.shear_y(normal), normal}, 320);
        const std::array model = {v.v1, v.v2, v.v3, v.v4};
        const std::array read = {raw[top + left + 1], raw[top + left], raw[top + width + left],
                                 raw[top + width + left + 1]};
        for (std::size_t n = 0; n < 4; ++n) {
          const bool usable = (observed.direct().status[i] & (1 << n)) != 0;
          EXPECT_TRUE(!usable || std::abs(model[n] - read[n]) < 1e-3);
        }
      }
    }
  }
}

TEST(FieldStudy, ThetaMidpointHasTheMiddleTheta) {
  for (const Scene& scene : few_scenes()) {
    const Observed observed(scene);
    const ForceField midpoint = observed.theta_midpoint();
    const ForceField& direct = observed.direct();
    for (const std::size_t i : observed.open()) {
      const double theta =
          std::atan2(std::hypot(midpoint.shear_x[i], midpoint.shear_y[i]), midpoint.normal[i]);
      const double low = direct.uncertainty[Uncertainty::theta_low][i];
      ASSERT_NEAR(theta, (low + std::numbers::pi / 2) / 2, 1e-5);
      ASSERT_NEAR(direct.uncertainty[Uncertainty::theta_high][i], std::numbers::pi / 2, 1e-6);
    }
  }
}

TEST(FieldStudy, TruthHasNoErrorAndIsCovered) {
  const Scene scene = few_scenes().front();
  const Observed observed(scene);
  ForceField truth = observed.truth();
  truth.status = observed.direct().status;
  truth.uncertainty = observed.direct().uncertainty;
  for (auto& bits : truth.status) bits |= status::kFromNeighbours;
  const Score score = observed.score(truth);
  EXPECT_EQ(score.rms_counts(), 0);
  EXPECT_EQ(score.coverage(), 1);
  EXPECT_EQ(score.resolved, score.open);
  EXPECT_GT(score.touched, 0);  // for regions 1 and 2 are not as they were
  EXPECT_EQ(observed.score(observed.direct()).touched, 0);
}

/// The truth, resolved, with a normal force that is off by so many of its deviations of 0.001 N.
ForceField off_by(const Observed& observed, double deviations) {
  ForceField field = observed.truth();
  field.status = observed.direct().status;
  field.uncertainty = observed.direct().uncertainty;
  for (const std::size_t i : observed.open()) {
    field.status[i] |= status::kFromNeighbours;
    field.uncertainty[Uncertainty::normal][i] = 1e-3F;
    field.normal[i] += static_cast<float>(1e-3 * deviations);
  }
  return field;
}

TEST(FieldStudy, BandOfResolvedPillarsIsThatOfTheirDeviation) {
  const Observed observed(few_scenes().front());
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_EQ(observed.score(off_by(observed, 1.95 * sign)).coverage(), 1);
    EXPECT_EQ(observed.score(off_by(observed, 1.97 * sign)).coverage(), 0);
  }
  EXPECT_EQ(observed.score(off_by(observed, 1.97)).resolved_covered, 0);
}

/// Where all slips at a friction that resolved pillars show, little but noise is left, and the band
/// is hardly wider.
TEST(FieldStudy, BandOfPillarsThatSlipHoldsNeitherTooFewNorAll) {
  for (const char* const name : {"sphere 31, spin, mu 1.8", "two spheres 21, spin, mu 2.3"}) {
    std::vector<Scene> scenes = tuning(name);
    integrate(scenes);
    double before = 0;
    for (const Scene& scene : scenes) {  // from the least noise on
      const Observed observed(scene);
      const ForceField solved = *solve(scene, observed, methods().front());
      const double coverage = observed.score(solved).coverage();
      EXPECT_GT(coverage, 0.93) << scene.name();
      EXPECT_LT(coverage, 0.99) << scene.name();
      double deviations = 0;
      for (const std::size_t i : observed.open()) {
        deviations += solved.uncertainty[Uncertainty::normal][i];
      }
      const double mean = deviations / static_cast<double>(observed.open().size());
      EXPECT_GT(mean, 1.3 * before) << scene.name();
      before = mean;
    }
  }
}

/// The upper end of a segment is off by the noise of one reading, over 2 k.
TEST(FieldStudy, BandOfOtherPillarsIsTheirSegment) {
  std::vector<Scene> scenes = tuning("punch 26, partial slip 0.75");
  integrate(scenes);
  std::size_t outside = 0;
  for (const Scene& scene : scenes) {
    const Observed observed(scene);
    std::size_t held = 0;
    for (const std::size_t i : observed.open()) {
      const double high = 2 * observed.direct().normal[i] + 1.96 * scene.noise_counts / (2 * 320);
      if (observed.truth().normal[i] <= high) ++held;
    }
    EXPECT_EQ(observed.score(observed.direct()).covered, held) << scene.name();
    outside += observed.open().size() - held;
  }
  EXPECT_GT(outside, 0);
}

TEST(FieldStudy, NearestIsNearest) {
  for (const Scene& scene : few_scenes()) {
    const Observed observed(scene);
    const double nearest = observed.score(observed.nearest()).rms_counts();
    EXPECT_LT(nearest, 2 * scene.noise_counts);
    for (const double step_n : {-1e-4, 1e-4}) {
      ForceField beside = observed.nearest();
      for (const std::size_t i : observed.open()) {
        const Segment segment = segment_of(observed.direct(), i);
        const double normal = beside.normal[i] + step_n;
        beside.shear_x[i] = static_cast<float>(segment.shear_x(normal));
        beside.shear_y[i] = static_cast<float>(segment.shear_y(normal));
        beside.normal[i] = static_cast<float>(normal);
      }
      EXPECT_GT(observed.score(beside).rms_counts(), nearest);
    }
  }
}

TEST(FieldStudy, LastOfTheFramesIsTheFrame) {
  const Scene scene = few_scenes().front();
  const Observed observed(scene);
  const std::vector<FrameBuffer> frames = observed.frames(3);
  const auto last = frames.back().readings<float>();
  const auto first = frames.front().readings<float>();
  const auto frame = observed.frame().readings<float>();
  EXPECT_TRUE(std::equal(last.begin(), last.end(), frame.begin(), frame.end()));
  EXPECT_FALSE(std::equal(first.begin(), first.end(), frame.begin(), frame.end()));
}

TEST(FieldStudy, MethodsAreWhereGoalsLookForThem) {
  EXPECT_EQ(methods().at(kNothingSaid).name, "nothing said");
  EXPECT_EQ(methods().at(kFrictionTold).name, "friction told");
  EXPECT_EQ(methods().at(kSlipTold).name, "friction told, and that it slips");
}

TEST(FieldStudy, SetsShareNoSceneFrictionOrSeed) {
  std::set<std::string> names;
  std::set<std::uint64_t> seeds;
  std::set<double> tuning_frictions;
  for (const Scene& scene : tuning()) {
    EXPECT_TRUE(names.insert(scene.name()).second) << scene.name();
    EXPECT_TRUE(seeds.insert(scene.seed).second);
    tuning_frictions.insert(scene.friction);
  }
  for (const Scene& scene : judging()) {
    EXPECT_TRUE(names.insert(scene.name()).second) << scene.name();
    EXPECT_TRUE(seeds.insert(scene.seed).second) << scene.name();
    EXPECT_EQ(tuning_frictions.count(scene.friction), 0);
  }
}

TEST(FieldStudy, SetsShareNoContact) {
  std::set<std::string> contacts;
  for (const Scene& scene : tuning()) contacts.insert(scene.contact_name);
  for (const Scene& scene : judging()) {
    EXPECT_EQ(contacts.count(scene.contact_name), 0) << scene.contact_name;
  }
}

TEST(FieldTwins, ReadTheSame) {
  const Twins twins = sliding_twins({});
  ASSERT_EQ(twins.first.size(), twins.second.size());
  double farthest = 0;
  for (std::size_t i = 0; i < twins.first.size(); ++i) {
    const auto& a = twins.first[i];
    const auto& b = twins.second[i];
    farthest = std::max(farthest, distance_counts(a, b));
    const auto v = readings_counts(a);
    const auto w = readings_counts(b);
    for (std::size_t n = 0; n < v.size(); ++n) EXPECT_NEAR(v[n], w[n], 1e-12 * 300);
    if (a.normal == 0) continue;
    EXPECT_NEAR(std::hypot(a.shear_x, a.shear_y) / a.normal, twins.first_friction, 1e-12);
    EXPECT_NEAR(std::hypot(b.shear_x, b.shear_y) / b.normal, twins.second_friction, 1e-12);
  }
  EXPECT_GT(farthest, 10);
  EXPECT_NE(twins.first_friction, twins.second_friction);
}

}  // namespace
}  // namespace pillarfield::field_study
