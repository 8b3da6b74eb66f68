// Faults found by parity over time, and good sensels that must not be masked.

#include "pillarfield/fault_finder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "pillarfield/simulator.h"
#include "skin/pillar_sensels.h"
#include "tests/base/message.h"

namespace pillarfield {
namespace {

using core_test::message_of;

constexpr std::uint32_t kPressedFrames = 200;
constexpr std::uint32_t kSize = 40;  // sensel rows and columns

/// A skin of 20 x 20 pillars with spread gains, tares and one count of noise.
Scene bare_scene() {
  Scene scene;
  scene.skin.rows = kSize;
  scene.skin.cols = kSize;
  scene.sensor.tare_counts = 12;
  scene.sensor.tare_spread_counts = 1.5;
  scene.sensor.gain_spread = 0.05;
  scene.sensor.noise_counts = 1;
  scene.sensor.adc_bits = 8;
  return scene;
}

/// A wide ball that presses all pillars, sways, and lets go.
Scene swaying_ball() {
  Scene scene = bare_scene();
  ClosedFormContact ball;
  ball.contact_radius_mm = 26;
  ball.reference_load_n = 300;
  ball.path = {{0, -2, -2, 20}, {0.5, 2, 0, 300}, {1, 0, 2, 40}, {1.5, 1, -2, 280}, {2, 0, 0, 5}};
  scene.load = std::vector<ClosedFormContact>{ball};
  return scene;
}

/// The true calibration, with its noise and a threshold that fits.
SkinCalibration calibration_of(const Simulator& simulator) {
  const Skin& skin = simulator.scene().skin;
  SkinCalibration calibration;
  calibration.rows = skin.rows;
  calibration.cols = skin.cols;
  calibration.planes = simulator.calibration();
  calibration.planes.noise.assign(skin.sensels(), 1.04F);
  calibration.threshold_counts = 4.5;
  return calibration;
}

/// Changes the readings of a frame.
using Spoil = std::function<void(FrameBuffer& frame)>;

void no_spoil(FrameBuffer&) {}

FaultResult faults_in(const Scene& scene, const Spoil& spoil, std::uint32_t frames = kPressedFrames,
                      std::uint32_t least_frames = kLeastFaultFrames,
                      const std::vector<std::uint8_t>& mask = {}) {
  const Simulator simulator(scene);
  const Skin& skin = simulator.scene().skin;
  SkinCalibration calibration = calibration_of(simulator);
  calibration.planes.mask = mask;
  FaultFinder finder("frames.h5", skin, simulator.sensel_type(), calibration, least_frames);
  FrameBuffer frame(simulator.sensel_type(), skin.rows, skin.cols);
  ForceField truth(skin.pillar_rows(), skin.pillar_cols());
  for (std::uint32_t t = 0; t < frames; ++t) {
    simulator.render(t, frame, truth);
    spoil(frame);
    finder.add(frame.view());
  }
  return finder.result();
}

/// Constant readings of some sensels.
Spoil reads(std::vector<std::pair<std::size_t, std::uint8_t>> readings) {
  return [readings](FrameBuffer& frame) {
    for (const auto& [sensel, reading] : readings) {
      frame.readings<std::uint8_t>()[sensel] = reading;
    }
  };
}

std::size_t place(std::uint32_t row, std::uint32_t col) { return std::size_t{row} * kSize + col; }

const SenselFinding* finding_at(const FaultResult& result, std::size_t sensel) {
  const auto found = std::ranges::find_if(result.findings, [&](const SenselFinding& finding) {
    return place(finding.row, finding.col) == sensel;
  });
  return found == result.findings.end() ? nullptr : &*found;
}

TEST(FaultFinder, GoodSenselsThatMoveAreGood) {
  const FaultResult result = faults_in(swaying_ball(), no_spoil);
  EXPECT_TRUE(result.findings.empty());
  EXPECT_TRUE(result.untested.empty());
  EXPECT_TRUE(result.calibration.planes.mask.empty());
  EXPECT_EQ(result.frames, kPressedFrames);
}

TEST(FaultFinder, DeadStuckAndSaturatedSenselsAreMasked) {
  const std::size_t dead = place(10, 10);       // sensel 2 of its pillar
  const std::size_t off = place(13, 15);        // 4
  const std::size_t stuck = place(20, 21);      // 1
  const std::size_t saturated = place(25, 30);  // 3
  const auto constant = reads({{dead, 0}, {stuck, 90}, {saturated, 255}});
  int t = 0;
  const FaultResult result = faults_in(swaying_ball(), [&](FrameBuffer& frame) {
    constant(frame);
    frame.readings<std::uint8_t>()[off] =
        static_cast<std::uint8_t>(11 + t++ % 3);  // its tare, and noise
  });
  EXPECT_EQ(result.findings.size(), 4U);
  const std::pair<std::size_t, SenselFault> expected[] = {{dead, SenselFault::unresponsive},
                                                          {off, SenselFault::unresponsive},
                                                          {stuck, SenselFault::stuck},
                                                          {saturated, SenselFault::saturated}};
  for (const auto& [sensel, fault] : expected) {
    const SenselFinding* const finding = finding_at(result, sensel);
    ASSERT_NE(finding, nullptr) << sensel;
    EXPECT_EQ(finding->fault, fault) << sensel;
    EXPECT_TRUE(finding->masked);
    EXPECT_EQ(result.calibration.planes.mask[sensel], 0);
  }
  EXPECT_EQ(count_masked(result.calibration.planes), 4U);
}

TEST(FaultFinder, ASenselThatIsNoNumberIsMasked) {
  Scene scene = swaying_ball();
  scene.sensor.adc_bits.reset();
  int t = 0;
  const FaultResult result = faults_in(scene, [&](FrameBuffer& frame) {
    frame.readings<float>()[place(8, 8)] = std::numeric_limits<float>::quiet_NaN();
    if (t++ == 7) frame.readings<float>()[place(4, 4)] = std::numeric_limits<float>::infinity();
  });
  ASSERT_EQ(result.findings.size(), 1U);
  EXPECT_EQ(result.findings[0].fault, SenselFault::not_a_number);
  EXPECT_EQ(result.calibration.planes.mask[place(8, 8)], 0);
}

TEST(FaultFinder, TwoInAPillarAreSuspectedAndNotMasked) {
  for (const std::size_t other : {place(11, 11), place(10, 11)}) {  // opposite, adjacent
    const FaultResult result = faults_in(swaying_ball(), reads({{place(10, 10), 0}, {other, 70}}));
    EXPECT_EQ(result.findings.size(), 2U);
    for (const std::size_t sensel : {place(10, 10), other}) {
      const SenselFinding* const finding = finding_at(result, sensel);
      ASSERT_NE(finding, nullptr);
      EXPECT_EQ(finding->fault, SenselFault::unknown);
      EXPECT_FALSE(finding->masked);
    }
    EXPECT_TRUE(result.calibration.planes.mask.empty());
  }
}

TEST(FaultFinder, AStillSenselBesideAMissingOneIsSuspected) {
  std::vector<std::uint8_t> mask(std::size_t{kSize} * kSize, 1);
  mask[place(10, 10)] = 0;
  const FaultResult result = faults_in(swaying_ball(), reads({{place(11, 10), 12}}), kPressedFrames,
                                       kLeastFaultFrames, mask);
  ASSERT_EQ(result.findings.size(), 1U);
  EXPECT_EQ(result.findings[0].fault, SenselFault::unknown);
  EXPECT_EQ(result.calibration.planes.mask, mask);
}

// Good sensels that stand still for a reason

/// Idle and under a constant press: nothing moves there, and elsewhere a ball sways.
TEST(FaultFinder, ConstantlyPressedAndIdleSenselsAreOnlyUntested) {
  Scene scene = bare_scene();
  ClosedFormContact punch;
  punch.shape = ContactShape::flat_punch;
  punch.contact_radius_mm = 5;
  punch.path = {{0, -6, 6, 12}};
  ClosedFormContact ball;
  ball.contact_radius_mm = 5;
  ball.reference_load_n = 20;
  ball.path = {{0, 6, -6, 0}, {1, 6, -6, 20}, {2, 6, -6, 0}};
  scene.load = std::vector<ClosedFormContact>{punch, ball};
  const FaultResult result = faults_in(scene, no_spoil);
  EXPECT_TRUE(result.findings.empty());
  const auto untested = [&](std::uint32_t row, std::uint32_t col) {
    return std::ranges::find(result.untested, std::pair{row, col}) != result.untested.end();
  };
  EXPECT_TRUE(untested(10, 10)) << "under the punch";
  EXPECT_TRUE(untested(2, 38)) << "idle";
  EXPECT_FALSE(untested(29, 29)) << "under the ball";
}

/// A load that comes and goes, whose direction keeps sensels inactive all the time.
TEST(FaultFinder, SenselsInactiveByShearAreNeverMasked) {
  for (const double direction_deg : {0.0, 45.0, 100.0, 225.0, 290.0}) {
    for (const double friction : {0.9, 1.2, 3.0}) {
      Scene scene = bare_scene();
      scene.sensor.adc_bits = 12;
      ClosedFormContact ball;
      ball.motion = ContactMotion::slide;
      ball.friction = friction;
      ball.direction_deg = direction_deg;
      ball.contact_radius_mm = 26;
      ball.reference_load_n = 300;
      ball.path = {{0, 0, 0, 20}, {0.7, 0, 0, 300}, {1.3, 0, 0, 30}, {2, 0, 0, 200}};
      scene.load = std::vector<ClosedFormContact>{ball};
      EXPECT_TRUE(faults_in(scene, no_spoil).calibration.planes.mask.empty())
          << direction_deg << " degrees, friction " << friction;
    }
  }
}

/// All of a recording in saturation: parity leaves more than full scale, and rightly.
TEST(FaultFinder, LegallySaturatedSenselsAreNotMasked) {
  Scene scene = bare_scene();
  scene.sensor.gain_spread = 0;
  scene.sensor.adc_bits = 8;
  ClosedFormContact ball;
  ball.motion = ContactMotion::slide;
  ball.friction = 0.4;
  ball.direction_deg = 45;
  ball.contact_radius_mm = 40;
  ball.reference_load_n = 1500;
  ball.path = {{0, 0, 0, 900}, {1, 0, 0, 1600}, {2, 0, 0, 900}};
  scene.load = std::vector<ClosedFormContact>{ball};
  const FaultResult result = faults_in(scene, no_spoil);
  EXPECT_EQ(count_masked(result.calibration.planes), 0U);
}

TEST(FaultFinder, NeedsFramesAndMovement) {
  const std::string few = message_of([] { (void)faults_in(swaying_ball(), no_spoil, 29); });
  EXPECT_EQ(few, "frames.h5: has 29 frames; give at least 30");
  const std::string idle = message_of([] { (void)faults_in(bare_scene(), no_spoil); });
  EXPECT_NE(idle.find("no sensel moved"), std::string::npos) << idle;
  SkinCalibration other;
  other.rows = 4;
  other.cols = 4;
  EXPECT_NE(message_of([&] {
              (void)FaultFinder("frames.h5", bare_scene().skin, SenselType::u8, other);
            }).find("4 x 4"),
            std::string::npos);
}

/// Too few loaded frames mask no sensel.
TEST(FaultFinder, AsksForLoadedFrames) {
  const Spoil spoil = reads({{place(20, 20), 0}});
  Scene late = swaying_ball();
  std::get<std::vector<ClosedFormContact>>(late.load)[0].path = {{0.8, 0, 0, 0}, {1, 0, 0, 300}};
  EXPECT_TRUE(faults_in(late, spoil, 100).findings.empty());
  EXPECT_EQ(faults_in(late, spoil, 100, 10).findings.size(), 1U);
}

}  // namespace
}  // namespace pillarfield
