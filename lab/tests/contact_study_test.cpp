#include "lab/studies/contact_study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "lab/studies/contact_study_histories.h"
#include "lab/studies/contact_study_scenes.h"
#include "lab/studies/contact_study_twins.h"
#include "pillarfield/status.h"
#include "simulation/closed_form/contact_traction.h"
#include "solve/pillar_maths.h"

namespace pillarfield::contact_study {
namespace {

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Shapes at a radius at which a pillar is not small, off the centre of the skin.
StudyContact contact_of(Shape shape) {
  StudyContact contact;
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
    case Shape::rounded_punch:
      break;
  }
  return 2 * kPi / 3 * (1 - std::pow(0.5, 3));
}

class OfEachShape : public testing::TestWithParam<Shape> {};

TEST_P(OfEachShape, ForcesSumToTheLoad) {
  const StudyContact contact = contact_of(GetParam());
  const PillarLoads loads = loads_of(contact);
  const double radius = contact.body.radius;
  const double load = closed_load(GetParam()) * radius * radius * loads.counts_per_pressure;
  EXPECT_NEAR(sum(loads.normal) / load, 1, GetParam() == Shape::punch ? 1e-2 : 1e-4);
  EXPECT_DOUBLE_EQ(*std::max_element(loads.normal.begin(), loads.normal.end()), 100);
}

TEST_P(OfEachShape, NoTractionExceedsFriction) {
  for (const Motion motion : {Motion::partial_slip, Motion::slide, Motion::spin, Motion::turn,
                              Motion::partial_turn, Motion::roll}) {
    StudyContact contact = contact_of(GetParam());
    contact.body.second = 0.3;
    contact.tangential = {.motion = motion, .load_ratio = 0.7, .pivot_x = 0.2};
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
                                         Shape::punch, Shape::rounded_punch));

/// The drag is the share of what friction can bear that the scene names.
TEST(FieldContacts, DragByTheirLoadRatio) {
  for (const Shape shape : {Shape::sphere, Shape::ellipse, Shape::paraboloid, Shape::cylinder,
                            Shape::cone, Shape::truncated_cone, Shape::rounded_punch}) {
    StudyContact contact = contact_of(shape);
    contact.body.second = 0.3;
    contact.tangential = {.motion = Motion::partial_slip, .direction_deg = 20, .load_ratio = 0.8};
    const PillarLoads loads = loads_of(contact);
    const double drag = std::hypot(sum(loads.shear_x), sum(loads.shear_y));
    EXPECT_NEAR(drag / sum(loads.normal), 0.8, 1e-3) << name_of(shape);
  }
}

/// What the simulator makes of the same contact, in counts and for friction 1: other mathematics,
/// corner functions instead of points.
ForceField simulated(const StudyContact& contact, const PillarLoads& loads) {
  const std::map<Motion, ContactMotion> motions = {
      {Motion::press, ContactMotion::press},
      {Motion::slide, ContactMotion::slide},
      {Motion::partial_slip, ContactMotion::partial_slip},
      {Motion::spin, ContactMotion::spin},
      {Motion::roll, ContactMotion::roll}};
  const Body& body = contact.body;
  Contact made;
  made.motion = motions.at(contact.tangential.motion);
  made.direction_deg = contact.tangential.direction_deg;
  if (body.shape == Shape::punch) made.shape = ContactShape::flat_punch;
  if (body.shape == Shape::cylinder) {
    made.shape = ContactShape::cylinder;
    made.direction_deg = body.angle_deg;
  }
  made.contact_radius_mm = body.radius;
  made.reference_load_n = sum(loads.normal);
  made.length_mm = 2 * body.aspect * body.radius;
  made.friction = 1;
  made.tangential_ratio = contact.tangential.load_ratio;
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
    StudyContact contact = contact_of(shape);
    if (shape != Shape::cylinder) contact.body.angle_deg = 0;
    contact.tangential = {.motion = motion, .direction_deg = 70, .load_ratio = 0.6};
    const PillarLoads loads = loads_of(contact);
    const ForceField forces = simulated(contact, loads);
    // Of 100 counts; at the edge of a punch the pressure has no end.
    const double margin = std::map<Shape, double>{
        {Shape::sphere, 0.03},
        {Shape::cylinder, 0.2},
        {Shape::punch, 2}}.at(shape);
    for (std::size_t i = 0; i < forces.pillars(); ++i) {
      ASSERT_NEAR(loads.normal[i], forces.normal[i], margin);
      ASSERT_NEAR(loads.shear_x[i], forces.shear_x[i], margin);
      ASSERT_NEAR(loads.shear_y[i], forces.shear_y[i], margin);
    }
  }
}

TEST(FieldContacts, SphereBearsItsPressureInTheMiddle) {
  StudyContact contact = contact_of(Shape::sphere);
  contact.tangential = {.motion = Motion::slide, .direction_deg = 90};
  const PillarLoads loads = loads_of(contact);
  const std::size_t middle = std::size_t{loads.rows / 2} * loads.cols + loads.cols / 2;
  EXPECT_NEAR(loads.normal[middle], 100, 0.5);
  EXPECT_NEAR(loads.shear_y[middle], loads.normal[middle], 1e-6);
  EXPECT_NEAR(loads.shear_x[middle], 0, 1e-6);
}

/// Recordings of a spinning sphere and of one in partial slip.
std::vector<Recording> few_recordings() {
  std::vector<ClosedForm> scenes = closed_forms("sphere 12, spin, mu 2, noise 0.5");
  const auto more = closed_forms("sphere 12, partial slip 0.9");
  scenes.insert(scenes.end(), more.begin(), more.begin() + 2);
  integrate(scenes);
  std::vector<Recording> recordings;
  recordings.reserve(scenes.size());
  for (const ClosedForm& scene : scenes) recordings.push_back(record(scene));
  return recordings;
}

Recording first_recording() { return std::move(few_recordings().front()); }

TEST(FieldStudy, SegmentsExplainTheReadings) {
  for (const Recording& recording : few_recordings()) {
    const Evaluation evaluation(recording);
    const ForceField& direct = evaluation.direct().front();
    const auto raw = recording.frames.front().readings<float>();
    const std::size_t width = 2 * std::size_t{direct.cols};
    ASSERT_GT(evaluation.ambiguous(0).size(), 30);
    for (const std::size_t i : evaluation.ambiguous(0)) {
      const Segment segment = segment_of(direct, i, recording.plan.segment_point);
      const std::size_t top = 2 * (i / direct.cols) * width;
      const std::size_t left = 2 * (i % direct.cols);
      for (const double share : {0.0, 0.3, 1.0}) {
        const double normal = share * segment.normal_high;
        const auto v = double_precision::model_readings(
            {segment.shear_x(normal), segment.shear_y(normal), normal}, 320);
        const std::array model = {v.v1, v.v2, v.v3, v.v4};
        const std::array read = {raw[top + left + 1], raw[top + left], raw[top + width + left],
                                 raw[top + width + left + 1]};
        for (std::size_t n = 0; n < 4; ++n) {
          const bool usable = (direct.status[i] & (1 << n)) != 0;
          EXPECT_TRUE(!usable || std::abs(model[n] - read[n]) < 1e-3);
        }
      }
    }
  }
}

TEST(FieldStudy, NearestIsNearest) {
  for (const Recording& recording : few_recordings()) {
    const Evaluation evaluation(recording);
    const double nearest = evaluation.score(evaluation.nearest()).rms_counts();
    EXPECT_LT(nearest, 2 * *recording.plan.noise_counts);
    for (const double step_n : {-1e-4, 1e-4}) {
      std::vector<ForceField> beside = evaluation.nearest();
      for (const std::size_t i : evaluation.ambiguous(0)) {
        const Segment segment = segment_of(evaluation.direct()[0], i, recording.plan.segment_point);
        const double normal = beside[0].normal[i] + step_n;
        beside[0].shear_x[i] = static_cast<float>(segment.shear_x(normal));
        beside[0].shear_y[i] = static_cast<float>(segment.shear_y(normal));
        beside[0].normal[i] = static_cast<float>(normal);
      }
      EXPECT_GT(evaluation.score(beside).rms_counts(), nearest);
    }
  }
}

/// The truth as an estimate whose components are off by `shift_n`, with a stated deviation of
/// 0.001 N and ends at the truth.
std::vector<ForceField> stated(const Recording& recording, const Evaluation& evaluation,
                               double shift_n) {
  ForceField field = recording.truth[0];
  for (auto& plane : field.uncertainty) plane.assign(field.pillars(), 1e-3F);
  auto& ends = field.uncertainty;
  for (const std::size_t i : evaluation.ambiguous(0)) {
    const double shear = std::hypot(field.shear_x[i], field.shear_y[i]);
    const double theta = std::atan2(shear, field.normal[i]);
    const double phi = std::atan2(-field.shear_y[i], -field.shear_x[i]);
    const double magnitude = std::hypot(shear, field.normal[i]);
    ends[Uncertainty::theta_low][i] = ends[Uncertainty::theta_high][i] = static_cast<float>(theta);
    ends[Uncertainty::phi_low][i] = ends[Uncertainty::phi_high][i] = static_cast<float>(phi);
    ends[Uncertainty::magnitude_low][i] = ends[Uncertainty::magnitude_high][i] =
        static_cast<float>(magnitude);
    for (auto* plane : {&field.shear_x, &field.shear_y, &field.normal}) {
      (*plane)[i] += static_cast<float>(shift_n);
    }
  }
  return {field};
}

TEST(FieldStudy, TruthHasNoErrorAndIsHeld) {
  const Recording recording = first_recording();
  const Evaluation evaluation(recording);
  const Score score = evaluation.score(stated(recording, evaluation, 0));
  EXPECT_EQ(score.rms_counts(), 0);
  EXPECT_EQ(score.total_bias(), 0);
  EXPECT_EQ(score.frames, 1);
  for (std::size_t i = 0; i < kIntervals; ++i)
    EXPECT_EQ(score.coverage(i), 1) << intervals()[i].name;
}

TEST(FieldStudy, ComponentsAreHeldUpTo196Deviations) {
  const Recording recording = first_recording();
  const Evaluation evaluation(recording);
  for (const double sign : {-1.0, 1.0}) {
    const Score inside = evaluation.score(stated(recording, evaluation, 1.95e-3 * sign));
    const Score outside = evaluation.score(stated(recording, evaluation, 1.97e-3 * sign));
    for (std::size_t i = 0; i < kFirstEnds; ++i) {
      EXPECT_EQ(inside.coverage(i), 1) << intervals()[i].name;
      EXPECT_EQ(outside.coverage(i), 0) << intervals()[i].name;
    }
  }
}

/// An arc that passes π holds what lies on it, and not the rest of the circle.
TEST(FieldStudy, ArcsOfPhiRunCounterClockwise) {
  ForceField truth(1, 1);
  ForceField solved(1, 1);
  for (auto& plane : solved.uncertainty) plane.assign(1, 0.0F);
  solved.uncertainty[Uncertainty::phi_low][0] = 3;
  solved.uncertainty[Uncertainty::phi_high][0] = -3;
  const auto& phi = intervals().back();
  for (const auto& [angle, held] :
       std::map<double, bool>{{3.1, true}, {-3.1, true}, {2.9, false}, {-2.9, false}, {0, false}}) {
    truth.shear_x[0] = static_cast<float>(-std::cos(angle));
    truth.shear_y[0] = static_cast<float>(-std::sin(angle));
    EXPECT_EQ(phi.holds(solved, truth, 0, 0), held) << angle;
    EXPECT_EQ(phi.holds(solved, truth, 0, 0.2 / 1.96), held || angle != 0) << angle;
  }
}

TEST(FieldStudy, ThrowsWhatWorkThrows) {
  EXPECT_THROW(for_each_index(10,
                              [](std::size_t i) {
                                if (i == 3) throw std::runtime_error("three");
                              }),
               std::runtime_error);
}

TEST(ClosedForms, HaveNamesAndSeedsOfTheirOwn) {
  std::set<std::string> names;
  std::set<std::uint64_t> seeds;
  for (const ClosedForm& scene : closed_forms()) {
    EXPECT_TRUE(names.insert(scene.name()).second) << scene.name();
    EXPECT_TRUE(seeds.insert(scene.seed).second) << scene.name();
  }
}

TEST(Histories, CoverBodiesMotionsFrictionsAndSizes) {
  std::set<std::pair<Indenter, double>> frictions;
  std::set<std::pair<Indenter, Loading>> of_indenter;
  std::set<std::pair<double, Loading>> of_friction;
  std::set<std::pair<double, double>> sizes;
  std::set<std::string> names;
  for (const History& history : histories()) {
    frictions.insert({history.indenter, history.friction});
    of_indenter.insert({history.indenter, history.loading});
    of_friction.insert({history.friction, history.loading});
    sizes.insert({history.friction, history.radius_pillars});
    EXPECT_TRUE(names.insert(history.name()).second) << history.name();
  }
  EXPECT_EQ(frictions.size(), 7 * 6);
  EXPECT_EQ(of_indenter.size(), 7 * 8);
  EXPECT_EQ(of_friction.size(), 6 * 8);
  EXPECT_EQ(sizes.size(), 6 * 6);
}

/// A finger that is pressed, and slides in the end.
TEST(Histories, TellWhichPillarsSlip) {
  const auto& all = histories();
  const auto found = std::find_if(all.begin(), all.end(), [](const History& history) {
    return history.name() == "fingertip 5, slide at 98°, mu 2.2";
  });
  ASSERT_NE(found, all.end());
  const auto estimates = friction_estimates(record(*found, PILLARFIELD_SCENES));
  ASSERT_EQ(estimates.size(), 10);  // one contact in each frame
  EXPECT_EQ(estimates.front().slipping, 0);
  EXPECT_GT(estimates.back().slipping, 0.95);
  EXPECT_NEAR(estimates.back().used, 2.2 / estimates.back().median, 0.2);
}

class SmallHistories : public testing::TestWithParam<Indenter> {
 protected:
  /// One whose contacts are small.
  static History history() {
    const auto& all = histories();
    return *std::find_if(all.begin(), all.end(), [](const History& each) {
      return each.indenter == GetParam() && each.radius_pillars <= 5 && each.friction >= 1.6;
    });
  }
};

TEST_P(SmallHistories, ReproduceBits) {
  const Recording one = record(history(), PILLARFIELD_SCENES);
  const Recording other = record(history(), PILLARFIELD_SCENES);
  ASSERT_EQ(one.frames.size(), other.frames.size());
  for (std::size_t i = 0; i < one.frames.size(); ++i) {
    const auto a = one.frames[i].readings<std::uint8_t>();
    const auto b = other.frames[i].readings<std::uint8_t>();
    EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
    EXPECT_EQ(one.truth[i].normal, other.truth[i].normal);
    EXPECT_EQ(one.truth[i].shear_x, other.truth[i].shear_x);
  }
}

TEST_P(SmallHistories, AreAsLargeAndAsAmbiguousAsTheySay) {
  const Recording recording = record(history(), PILLARFIELD_SCENES);
  const Evaluation evaluation(recording);
  EXPECT_GE(recording.frames.size(), 8);
  EXPECT_LE(recording.frames.size(), 12);
  std::uint8_t peak = 0;
  double most_pillars = 0;
  std::size_t ambiguous = 0;
  for (std::size_t i = 0; i < recording.frames.size(); ++i) {
    const auto readings = recording.frames[i].readings<std::uint8_t>();
    peak = std::max(peak, *std::max_element(readings.begin(), readings.end()));
    const auto& normal = recording.truth[i].normal;
    const auto loaded =
        std::count_if(normal.begin(), normal.end(), [](float force_n) { return force_n > 0; });
    most_pillars = std::max(most_pillars, static_cast<double>(loaded));
    ambiguous += evaluation.ambiguous(i).size();
  }
  EXPECT_GE(peak, 145);
  EXPECT_LE(peak, 155);
  const double bodies = history().indenter == Indenter::two_fingers ? 2 : 1;
  // Pillars that are loaded in part count as well.
  EXPECT_NEAR(std::sqrt(most_pillars / bodies / std::numbers::pi), history().radius_pillars, 0.8);
  EXPECT_GE(ambiguous, 50);
}

INSTANTIATE_TEST_SUITE_P(OfEachIndenter, SmallHistories,
                         testing::Values(Indenter::sphere, Indenter::fingertip, Indenter::cylinder,
                                         Indenter::punch, Indenter::rough_ball, Indenter::key,
                                         Indenter::two_fingers));

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
}  // namespace pillarfield::contact_study
