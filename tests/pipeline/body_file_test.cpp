// Files of bodies, the ready ones and wrong ones, and clocks of sensors.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "pillarfield/whole_body.h"
#include "pipeline/body/patch_clock.h"
#include "tests/base/message.h"

namespace pillarfield {
namespace {

const std::filesystem::path kFolder = PILLARFIELD_SCENES "/body";

std::string message_of_body(const std::string& text) {
  const std::filesystem::path file = kFolder / "b.toml";
  std::string message = core_test::message_of([&] { static_cast<void>(parse_body(text, file)); });
  EXPECT_EQ(message.find('\n'), std::string::npos);
  if (message.starts_with(kFolder.string())) message.erase(0, kFolder.string().size() + 1);
  return message;
}

/// A patch in lines 1 to 3, then what is given.
std::string with_patch(const std::string& text) {
  return "[[patch]]\nname = \"a\"\nscene = \"small.toml\"\n" + text;
}

TEST(BodyFile, DescribesPatchesWithSizePoseAndClock) {
  const BodyFile body = parse_body(
      with_patch("size_mm = [40, 25.3]\nseed = 5\norigin_mm = [1, 2, 3]\ntangent_x = [0, 2, 0]\n"
                 "tangent_y = [0, 0, 3]\nclock_offset_s = 1.5\nclock_drift_ppm = -20\n"),
      kFolder / "b.toml");
  ASSERT_EQ(body.skin.patches.size(), 1U);
  const BodyPatch& patch = body.skin.patches.front();
  EXPECT_EQ(patch.name, "a");
  EXPECT_EQ(patch.plan.skin.cols, 64U);
  EXPECT_EQ(patch.plan.skin.rows, 40U);
  EXPECT_EQ(patch.plan.calibration.tare.size(), 64U * 40U);
  EXPECT_EQ(patch.pose.position_mm.z, 3);
  EXPECT_EQ(patch.pose.tangent_x.y, 1);
  EXPECT_EQ(patch.pose.normal.x, 1);
  EXPECT_EQ(body.simulated.front().scene.seed, 5U);
  EXPECT_EQ(body.simulated.front().clock_drift_ppm, -20);
}

TEST(BodyFile, SaysInOneLineWhatIsWrong) {
  const auto begins = [](const std::string& text, const std::string& message) {
    EXPECT_EQ(message_of_body(text).substr(0, message.size()), message) << text;
  };
  begins("rate_hz = 0", "b.toml:1: key 'rate_hz' in the body is 0; allowed: ");
  begins("colour = 3", "b.toml:1: key 'colour' in the body is unknown here; allowed: title, ");
  begins("title = \"x\"", "b.toml:1: key 'patch' in the body is missing; allowed: ");
  begins("patch = 3", "b.toml:1: key 'patch' in the body is 3; allowed: a list of tables");
  begins("[[patch]]\nname = \"a\"", "b.toml:1: key 'scene' in [[patch]] is missing; allowed: ");
  begins("[[patch]]\nscene = \"small.toml\"", "b.toml:1: key 'name' in [[patch]] is missing");
  begins(with_patch("tangent_y = [1, 0, 0]"),
         "b.toml:4: key 'tangent_y' in [[patch]] is not perpendicular to tangent_x; allowed: ");
  begins(with_patch("tangent_x = [0, 0, 0]"), "b.toml:1: key 'tangent_y' in [[patch]] is not");
  begins(with_patch("origin_mm = [1, 2]"), "b.toml:4: key 'origin_mm' in [[patch]] is a list of 2");
  begins(with_patch("clock_drift_ppm = nan"),
         "b.toml:4: key 'clock_drift_ppm' in [[patch]] is nan");
  begins(with_patch("pose = 3"), "b.toml:4: key 'pose' in [[patch]] is unknown here");
  begins(
      with_patch("size_mm = [1e5, 5]"),
      "b.toml:4: key 'size_mm' in [[patch]] has an element that is 100000; allowed: a list of 2");
  begins(with_patch(with_patch("")), "b.toml: two patches have the name \"a\"");
  begins("[[patch]]\nname = \"a\"\nscene = \"none.toml\"", "none.toml: cannot be read");
  begins(with_patch("calibration = \"none.h5\""), "none.h5");
  begins("= 3", "b.toml:1: is not TOML");
}

TEST(BodyFile, OfTheScenesCoversThe18000SquareCentimetresOfAHumanoid) {
  double area_m2 = 0;
  const BodyFile body = load_body(kFolder / "humanoid.toml");
  for (const BodyPatch& patch : body.skin.patches) {
    const double pitch_m = 1e-3 * patch.plan.skin.pillar_pitch_mm();
    area_m2 += static_cast<double>(patch.plan.skin.pillars()) * pitch_m * pitch_m;
  }
  EXPECT_NEAR(area_m2, 1.8, 0.02);
  EXPECT_EQ(body.simulated.size(), body.skin.patches.size());
  EXPECT_EQ(load_body(kFolder / "hand.toml").skin.patches.size(), 2U);
}

constexpr std::uint64_t kMillisecond = 1'000'000;

std::chrono::nanoseconds nanos(double seconds) {
  return std::chrono::nanoseconds(std::llround(1e9 * seconds));
}

TEST(PatchClock, FollowsOffsetAndDriftThroughThePacketsThatWaitedLeast) {
  std::mt19937 random(5);
  std::exponential_distribution<double> delay_s(1 / 300e-6);
  PatchClock clock;
  double worst_s = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double host_s = 100 + 1e-3 * i;
    const auto device_ns = static_cast<std::uint64_t>(1e9 * (5e4 + 1e-3 * i * (1 + 80e-6)));
    clock.add(device_ns, nanos(host_s + delay_s(random)));
    if (i < 3000) continue;
    const auto error = clock.host_time(device_ns) - nanos(host_s);
    worst_s = std::max(worst_s, std::abs(1e-9 * static_cast<double>(error.count())));
  }
  EXPECT_LT(worst_s, 50e-6);  // The drift alone makes 1.6 ms in 20 s, the mean delay 0.3 ms.
}

TEST(PatchClock, BeginsAnewAfterAJump) {
  PatchClock clock;
  for (unsigned i = 1; i < 3000; ++i) clock.add(i * kMillisecond, nanos(1e-3 * i));
  clock.add(50 * kMillisecond, nanos(3.5));
  EXPECT_EQ(clock.host_time(50 * kMillisecond), nanos(3.5));
  clock.add(90'000 * kMillisecond, nanos(3.6));
  EXPECT_EQ(clock.host_time(90'000 * kMillisecond), nanos(3.6));
}

}  // namespace
}  // namespace pillarfield
