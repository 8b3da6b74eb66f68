// A body of patches: forces with the bits of whole frames, healing of losses, poses, packets that
// are not to be trusted.

#include "pillarfield/whole_body.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <random>

#include "pillarfield/error.h"
#include "pillarfield/surface.h"
#include "pipeline/body/block_sender.h"
#include "pipeline/body/patch_stack.h"
#include "skin/vectors.h"
#include "tests/device/random_plan.h"
#include "tests/device/same_bits.h"
#include "tests/device/test_device.h"

namespace pillarfield {
namespace {

using std::chrono::milliseconds;

/// A plan whose program does not depend on `seed`.
SolverPlan patch_plan(std::uint32_t rows, std::uint32_t cols, std::uint32_t seed) {
  SolverPlan plan = full_plan(rows, cols, SenselType::u8, seed);
  plan.calibration.noise.clear();
  return plan;
}

SolverPlan leaking(SolverPlan plan) {
  plan.calibration.effects.sensel_leak = {0.05, 0.02};
  plan.calibration.effects.pillar_leak = {0.03, 0.01};
  plan.calibration.effects.arm_mm = 0.4;
  return plan;
}

BodySkin body_of(std::vector<SolverPlan> plans) {
  BodySkin skin;
  skin.refresh_s = 0.05;
  for (SolverPlan& plan : plans) {
    const Pose pose = {{}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    skin.patches.push_back({"patch " + std::to_string(skin.patches.size()), std::move(plan), pose});
  }
  return skin;
}

/// Three patches of one width, of which two also of one height; two that leak; one of odd size; one
/// whose tare follows drift.
std::vector<SolverPlan> many_plans() {
  SolverPlan drifting = patch_plan(20, 48, 7);
  drifting.baseline_rate = 0.2;
  return {patch_plan(40, 62, 1),
          patch_plan(40, 62, 2),
          leaking(patch_plan(24, 62, 3)),
          leaking(patch_plan(30, 62, 4)),
          patch_plan(16, 62, 5),
          patch_plan(33, 51, 6),
          drifting};
}

/// A frame with noise and a disc that wanders, sometimes in the air.
class Touched {
 public:
  Touched(const SolverPlan& plan, std::uint32_t seed)
      : frame(SenselType::u8, plan.skin.rows, plan.skin.cols), plan_(plan), random_(seed) {}

  void step() {
    const Skin& skin = plan_.skin;
    row_ = std::clamp(row_ + uniform(-2, 2), 0.0, 1.0 * skin.rows);
    col_ = std::clamp(col_ + uniform(-2, 2), 0.0, 1.0 * skin.cols);
    if (uniform(0, 1) < 0.05) pressed_ = !pressed_;
    for (std::uint32_t row = 0; row < skin.rows; ++row) {
      for (std::uint32_t col = 0; col < skin.cols; ++col) {
        const std::size_t at = std::size_t{row} * skin.cols + col;
        const bool loaded = pressed_ && std::hypot(row - row_, col - col_) < 9;
        const double reading =
            plan_.calibration.tare[at] + uniform(-1, 1) + (loaded ? uniform(0, 200) : 0);
        frame.readings<std::uint8_t>()[at] =
            static_cast<std::uint8_t>(std::clamp(reading, 0.0, 255.0));
      }
    }
  }

  FrameBuffer frame;

 private:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  const SolverPlan& plan_;
  std::mt19937 random_;
  double row_ = 8;
  double col_ = 10;
  bool pressed_ = true;
};

/// A body, its sensors, and a processor of whole frames for each patch.
class Rig {
 public:
  explicit Rig(std::vector<SolverPlan> plans, std::uint64_t refresh_frames = 50)
      : body(test_device(), body_of(std::move(plans))) {
    const auto& patches = body.skin().patches;
    for (std::uint32_t i = 0; i < patches.size(); ++i) {
      touched.emplace_back(patches[i].plan, i + 1);
      senders.emplace_back(patches[i].plan, i, refresh_frames);
      whole.emplace_back(test_device(), patches[i].plan);
    }
  }

  /// A frame of all patches, of which packets are lost with this probability.
  void step(double loss = 0) {
    ++frame;
    for (std::size_t i = 0; i < touched.size(); ++i) {
      touched[i].step();
      senders[i].send(touched[i].frame, frame, frame * 1'000'000,
                      [&](const PillarfieldPacket& header, std::span<const std::byte> readings) {
                        if (uniform(random) < loss) return;
                        EXPECT_TRUE(body.receive(header, readings, milliseconds(frame)));
                      });
    }
    body.solve();
  }

  /// Whether the forces of a patch have the bits of its whole frames; to be asked in each frame
  /// where frames leave a memory.
  [[nodiscard]] bool is_same(std::size_t patch) {
    whole[patch].submit(touched[patch].frame.view());
    const ForceFieldView expected = whole[patch].receive();
    const ForceFieldView& actual = body.patch(patch).forces;
    const auto same = [](std::span<const float> a, std::span<const float> b) {
      return std::ranges::equal(std::as_bytes(a), std::as_bytes(b));
    };
    return same(actual.shear_x, expected.shear_x) && same(actual.shear_y, expected.shear_y) &&
           same(actual.normal, expected.normal) &&
           std::ranges::equal(actual.status, expected.status);
  }

  WholeBody body;
  std::vector<Touched> touched;
  std::vector<BlockSender> senders;
  std::vector<Processor> whole;
  std::uint64_t frame = 0;
  std::mt19937 random{3};
  std::uniform_real_distribution<double> uniform{0, 1};
};

TEST(WholeBody, HasTheBitsOfEachPatchSolvedWhole) {
  Rig rig(many_plans());
  std::uint64_t changed = 0;
  for (int i = 0; i < 120; ++i) {
    rig.step();
    for (std::size_t patch = 0; patch < rig.touched.size(); ++patch) {
      ASSERT_TRUE(rig.is_same(patch)) << "patch " << patch << " in frame " << i;
    }
    changed += rig.senders[0].changed();
  }
  EXPECT_LT(changed, 120 * 40 / 2) << "hardly a block is idle";
}

TEST(WholeBody, SolvesPatchesOfOneWidthAndProgramTogether) {
  const BodySkin skin = body_of(many_plans());
  const std::vector<std::vector<std::size_t>> expected = {{0, 1, 4}, {2, 3}, {5}, {6}};
  EXPECT_EQ(PatchStack::divide(test_device(), skin), expected);
}

TEST(WholeBody, HealsLossesWithinTheRefreshPeriod) {
  Rig rig({patch_plan(40, 62, 1), leaking(patch_plan(24, 62, 3))});
  int wrong = 0;
  for (int i = 0; i < 200; ++i) {
    rig.step(0.2);
    if (!rig.is_same(0)) ++wrong;
  }
  EXPECT_GT(wrong, 50) << "the losses change nothing";
  EXPECT_TRUE(rig.body.patch(0).stale);
  EXPECT_GT(rig.body.patch(0).health.lost, 20U);
  for (int i = 0; i < 50; ++i) rig.step();
  EXPECT_TRUE(rig.is_same(0) && rig.is_same(1));
  for (int i = 0; i < 2; ++i) rig.step();
  EXPECT_FALSE(rig.body.patch(0).stale);
}

TEST(WholeBody, TakesWholeFramesAndRowsToo) {
  Rig rig({patch_plan(40, 62, 1), patch_plan(40, 62, 2)});
  rig.step();
  for (const bool whole : {true, false}) {
    rig.touched[1].step();
    const std::uint32_t half = whole ? 40 : 20;
    for (std::uint32_t first = 0; first < 40; first += half) {
      PillarfieldPacket header = {};
      header.magic = PILLARFIELD_PACKET_MAGIC;
      header.content = whole ? PILLARFIELD_FRAME : PILLARFIELD_ROWS;
      header.type = PILLARFIELD_U8;
      header.rows = 40;
      header.cols = 62;
      header.session = 1;
      header.sequence = whole ? 2 : 3;
      header.parts = 40 / half;
      header.part = first / half;
      header.first = first;
      header.count = half;
      header.patch = 1;
      header.bytes = half * 62;
      const auto rows = std::as_bytes(rig.touched[1].frame.readings<std::uint8_t>());
      EXPECT_TRUE(
          rig.body.receive(header, rows.subspan(std::size_t{62} * first, header.bytes), {}));
    }
    rig.body.solve();
    EXPECT_TRUE(rig.is_same(1));
  }
}

/// A packet of one block of the first patch.
struct BlockPacket {
  BlockPacket(const FrameShape& shape, std::uint64_t sequence, std::uint32_t number, int reading) {
    header.magic = PILLARFIELD_PACKET_MAGIC;
    header.content = PILLARFIELD_BLOCKS;
    header.type = PILLARFIELD_U8;
    header.rows = shape.rows;
    header.cols = shape.cols;
    header.session = 1;
    header.sequence = sequence;
    header.parts = 1;
    header.count = 1;
    bytes.assign(shape.block_bytes(), std::byte(reading));
    std::fill_n(bytes.begin(), 8, std::byte{0});
    bytes[0] = std::byte(number);
    header.bytes = static_cast<std::uint32_t>(bytes.size());
  }
  PillarfieldPacket header = {};
  std::vector<std::byte> bytes;
};

int first_reading(const WholeBody& body) {
  return *static_cast<const std::uint8_t*>(body.readings(0).data);
}

TEST(WholeBody, DoesNotUsePacketsOfFramesBeforeTheNewest) {
  WholeBody body(test_device(), body_of({bare_plan(16, 32, SenselType::u8)}));
  const FrameShape shape = {SenselType::u8, 16, 32};
  const auto receive = [&](std::uint64_t sequence, int reading) {
    const BlockPacket packet(shape, sequence, 0, reading);
    EXPECT_TRUE(body.receive(packet.header, packet.bytes, milliseconds(sequence)));
    body.solve();
    return first_reading(body);
  };
  EXPECT_EQ(receive(5, 10), 10);
  EXPECT_EQ(receive(4, 20), 10);
  EXPECT_EQ(receive(5, 30), 10) << "the same packet again";
  EXPECT_EQ(receive(8, 40), 40);
  EXPECT_EQ(body.patch(0).health.late, 2U);
  EXPECT_EQ(body.patch(0).health.lost, 2U);
  EXPECT_EQ(receive(2'000'000, 50), 50) << "a sequence that began anew";
  EXPECT_EQ(body.patch(0).health.restarts, 1U);
}

TEST(WholeBody, TakesPacketsWithAChecksumOfAnyPatch) {
  const SolverPlan plan = bare_plan(16, 32, SenselType::u8);
  WholeBody body(test_device(), body_of({plan, plan}));
  for (const std::uint32_t patch : {0U, 1U}) {
    BlockPacket packet({SenselType::u8, 16, 32}, 1, 0, 9);
    packet.header.patch = patch;
    packet.header.content |= PILLARFIELD_CHECKED;
    packet.header.bytes += 4;
    uLong sum = crc32_z(0, reinterpret_cast<const Bytef*>(&packet.header), sizeof packet.header);
    sum = crc32_z(sum, reinterpret_cast<const Bytef*>(packet.bytes.data()), packet.bytes.size());
    for (int byte = 0; byte < 4; ++byte) {
      packet.bytes.push_back(static_cast<std::byte>(sum >> 8 * byte & 0xFF));
    }
    EXPECT_TRUE(body.receive(packet.header, packet.bytes, {})) << patch;
    packet.bytes.front() ^= std::byte{1};
    EXPECT_FALSE(body.receive(packet.header, packet.bytes, {})) << patch;
  }
}

TEST(WholeBody, ASequenceMayBeginAnywhereAfterItsEndOrAPause) {
  WholeBody body(test_device(), body_of({bare_plan(16, 32, SenselType::u8)}));
  const FrameShape shape = {SenselType::u8, 16, 32};
  const auto receive = [&](std::uint64_t sequence, int reading, milliseconds arrived) {
    const BlockPacket packet(shape, sequence, 0, reading);
    EXPECT_TRUE(body.receive(packet.header, packet.bytes, arrived));
    body.solve();
    return first_reading(body);
  };
  EXPECT_EQ(receive(900, 10, milliseconds(900)), 10);
  EXPECT_EQ(receive(890, 20, milliseconds(901)), 10) << "late";
  EXPECT_EQ(receive(890, 20, milliseconds(1402)), 20) << "after a pause";
  PillarfieldPacket end = BlockPacket(shape, 891, 0, 0).header;
  end.content = PILLARFIELD_END;
  end.bytes = 0;
  EXPECT_TRUE(body.receive(end, {}, milliseconds(1403)));
  EXPECT_EQ(receive(800, 30, milliseconds(1404)), 30) << "after its end";
  EXPECT_EQ(body.patch(0).health.restarts, 2U);
}

TEST(WholeBody, APartThatComesTwiceDoesNotCountForAnother) {
  WholeBody body(test_device(), body_of({bare_plan(16, 32, SenselType::u8)}));
  const FrameShape shape = {SenselType::u8, 16, 32};
  for (const std::uint32_t part : {0U, 0U, 1U}) {
    BlockPacket packet(shape, 7, part, 30);
    packet.header.parts = 2;
    packet.header.part = static_cast<decltype(packet.header.part)>(part);
    EXPECT_TRUE(body.receive(packet.header, packet.bytes, milliseconds(7)));
  }
  EXPECT_EQ(body.patch(0).health.packets, 0U) << "before solve()";
  body.solve();
  EXPECT_EQ(body.patch(0).health.packets, 2U);
  EXPECT_EQ(body.patch(0).health.late, 1U);
}

TEST(WholeBody, RefusesPacketsThatContradictThePatch) {
  WholeBody body(test_device(), body_of({bare_plan(16, 32, SenselType::u8)}));
  const BlockPacket good({SenselType::u8, 16, 32}, 1, 0, 9);
  std::vector<BlockPacket> wrong(9, good);
  wrong[0].header.patch = 1;
  wrong[1].header.patch = 0xFFFFFFFF;
  wrong[2].header.rows = 18;
  wrong[3].header.type = PILLARFIELD_U16;
  wrong[4].bytes[0] = std::byte{8};  // The skin has blocks 0 to 7.
  wrong[5].bytes.pop_back();
  wrong[6].header.count = 2;
  wrong[7].header.parts = 0;
  wrong[8].header.magic = 0;
  for (const BlockPacket& packet : wrong) {
    EXPECT_FALSE(body.receive(packet.header, packet.bytes, {}));
  }
  EXPECT_EQ(body.invalid(), wrong.size());
  EXPECT_EQ(first_reading(body), 0);
  EXPECT_TRUE(body.receive(good.header, good.bytes, {}));
  EXPECT_EQ(first_reading(body), 9);
}

TEST(WholeBody, OfNoPatchOrWithAPoseThatIsNoneIsRefused) {
  EXPECT_THROW(WholeBody(test_device(), BodySkin{}), Error);
  BodySkin skewed = body_of({bare_plan(16, 32, SenselType::u8)});
  skewed.patches[0].pose.tangent_x = {0.9, 0, 0};
  EXPECT_THROW(WholeBody(test_device(), skewed), Error);
  skewed.patches[0].pose = {{}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
  EXPECT_THROW(WholeBody(test_device(), skewed), Error);
}

/// Force and moment of all pillars, one after the other, in long double.
BodyLoad load_by_pillars(const BodyPatch& patch, const ForceFieldView& forces) {
  const Skin& skin = patch.plan.skin;
  const auto poses = poses_of(skin.surface.value_or(Surface{}), skin.pillar_layout());
  const auto turned = [&](const Vector3& v) {
    return v.x * patch.pose.tangent_x + v.y * patch.pose.tangent_y + v.z * patch.pose.normal;
  };
  BodyLoad load;
  Vector3 place;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double normal = forces.normal[i];
    const Vector3 force =
        turned(double{forces.shear_x[i]} * poses[i].tangent_x +
               double{forces.shear_y[i]} * poses[i].tangent_y - normal * poses[i].normal);
    const Vector3 at = patch.pose.position_mm + turned(poses[i].position_mm);
    load.wrench.force_n = load.wrench.force_n + force;
    load.wrench.moment_nmm = load.wrench.moment_nmm + cross(at, force);
    load.normal_n += normal;
    place = place + normal * at;
  }
  load.centre_of_pressure_mm = 1 / load.normal_n * place;
  return load;
}

void expect_near(const Vector3& actual, const Vector3& expected, double tolerance) {
  EXPECT_NEAR(actual.x, expected.x, tolerance);
  EXPECT_NEAR(actual.y, expected.y, tolerance);
  EXPECT_NEAR(actual.z, expected.z, tolerance);
}

TEST(WholeBody, AddsLoadsInItsFrame) {
  std::vector<SolverPlan> plans = {patch_plan(40, 62, 1), patch_plan(40, 62, 2),
                                   leaking(patch_plan(33, 51, 6))};
  Surface& round = plans[1].skin.surface.emplace();
  round.shape = SurfaceShape::cylinder;
  round.radius_mm = 30;
  BodySkin skin = body_of(plans);
  skin.patches[0].pose = {{10, 20, 30}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  skin.patches[1].pose = {{-5, 0, 7}, {0.6, 0.8, 0}, {-0.8, 0.6, 0}, {0, 0, 1}};
  WholeBody body(test_device(), skin);
  std::vector<Touched> touched;
  std::vector<BlockSender> senders;
  for (std::uint32_t i = 0; i < 3; ++i) {
    touched.emplace_back(skin.patches[i].plan, i + 4);
    senders.emplace_back(skin.patches[i].plan, i, 50);
  }
  for (std::uint64_t frame = 1; frame < 25; ++frame) {
    Vector3 force;
    Vector3 moment;
    for (std::size_t i = 0; i < 3; ++i) {
      touched[i].step();
      senders[i].send(touched[i].frame, frame, 0, [&](const auto& header, auto readings) {
        body.receive(header, readings, {});
      });
    }
    body.solve();
    for (std::size_t i = 0; i < 3; ++i) {
      const BodyLoad expected = load_by_pillars(skin.patches[i], body.patch(i).forces);
      const BodyLoad& actual = body.patch(i).load;
      expect_near(actual.wrench.force_n, expected.wrench.force_n, 1e-9);
      expect_near(actual.wrench.moment_nmm, expected.wrench.moment_nmm, 1e-7);
      EXPECT_NEAR(actual.normal_n, expected.normal_n, 1e-9);
      if (actual.centre_of_pressure_mm) {
        expect_near(*actual.centre_of_pressure_mm, *expected.centre_of_pressure_mm, 1e-7);
      }
      force = force + expected.wrench.force_n;
      moment = moment + expected.wrench.moment_nmm;
    }
    expect_near(body.load().wrench.force_n, force, 1e-9);
    expect_near(body.load().wrench.moment_nmm, moment, 1e-7);
  }
  EXPECT_GT(body.patch(0).load.normal_n + body.patch(1).load.normal_n, 1);
}

TEST(WholeBody, TurnedAsAWholeHasTheSameLoadTurned) {
  const SolverPlan plan = patch_plan(40, 62, 1);
  BodySkin skin = body_of({plan, plan});
  skin.patches[0].pose = {{3, 4, 5}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  // About z by 90 degrees: x to y, y to -x.
  skin.patches[1].pose = {{-4, 3, 5}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
  WholeBody body(test_device(), skin);
  Touched touched(plan, 9);
  touched.step();
  for (std::uint32_t i = 0; i < 2; ++i) {
    BlockSender(plan, i, 50).send(touched.frame, 1, 0, [&](const auto& header, auto readings) {
      body.receive(header, readings, {});
    });
  }
  body.solve();
  const auto turned = [](const Vector3& v) { return Vector3{-v.y, v.x, v.z}; };
  const BodyLoad& before = body.patch(0).load;
  const BodyLoad& after = body.patch(1).load;
  ASSERT_GT(before.normal_n, 0.5);
  expect_near(after.wrench.force_n, turned(before.wrench.force_n), 1e-9);
  expect_near(after.wrench.moment_nmm, turned(before.wrench.moment_nmm), 1e-7);
  expect_near(*after.centre_of_pressure_mm, turned(*before.centre_of_pressure_mm), 1e-9);
}

}  // namespace
}  // namespace pillarfield
