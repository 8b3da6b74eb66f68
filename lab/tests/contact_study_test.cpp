#include "lab/studies/contact_study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "lab/studies/contact_study_histories.h"
#include "pillarfield/scene.h"
#include "pillarfield/simulator.h"
#include "pillarfield/status.h"
#include "solve/pillar_maths.h"

namespace pillarfield::contact_study {
namespace {

/// One frame of each of two scenes.
std::vector<Recording> few_recordings() {
  std::vector<Recording> recordings;
  for (const char* name : {"ambiguous_contacts.toml", "slide_and_spin.toml"}) {
    const Scene scene = load_scene(std::filesystem::path(PILLARFIELD_SCENES) / name);
    const Simulator simulator(scene);
    FrameBuffer frame(simulator.sensel_type(), scene.skin.rows, scene.skin.cols);
    ForceField truth(scene.skin.pillar_rows(), scene.skin.pillar_cols());
    simulator.render(scene.frames - 1, frame, truth);
    recordings.push_back(read_forces(scene, {truth}));
  }
  return recordings;
}

Recording first_recording() { return std::move(few_recordings().front()); }

TEST(FieldStudy, SegmentsExplainTheReadings) {
  for (const Recording& recording : few_recordings()) {
    const Evaluation evaluation(recording);
    const ForceField& direct = evaluation.direct().front();
    const auto raw = recording.frames.front().readings<std::uint8_t>();
    const std::size_t width = 2 * std::size_t{direct.cols};
    ASSERT_GT(evaluation.ambiguous(0).size(), 20);
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
  for (auto& plane : field.uncertainty) plane.assign(field.elements(), 1e-3F);
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

}  // namespace
}  // namespace pillarfield::contact_study
