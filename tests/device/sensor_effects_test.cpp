// The corrections of a real sensor give the bits of the host, on every path, over sequences of
// frames whose contacts move, with and without skipping idle blocks.

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "pillarfield/host_solve.h"
#include "pillarfield/processor.h"
#include "pillarfield/status.h"
#include "pillarfield/tuning.h"
#include "random_plan.h"
#include "tests/device/host_reference.h"
#include "tests/device/test_device.h"

namespace pillarfield {
namespace {

using Path = DevicePath;

constexpr int kFrames = 12;
constexpr int kInFlight = 3;  ///< frames that may overlap on the device
constexpr std::uint32_t kRows = 2 * 19;
constexpr std::uint32_t kCols = 2 * 53;

ResponseCurve some_curve(SenselType type) {
  const double unit = type == SenselType::u16 ? 16 : 1;
  return {{20 * unit, 60 * unit, 130 * unit, 220 * unit},
          {15 * unit, 55 * unit, 140 * unit, 270 * unit}};
}

SenselMemory some_memory() {
  return {{{0, 0.05}, {30, 0.04}, {100, 0.03}}, {{0.05, 0.03}, {0.4, 0.02}}};
}

SensorEffects all_effects(SenselType type) {
  SensorEffects effects;
  effects.curve = some_curve(type);
  effects.shear_coefficient = {0.9, 1.1};
  effects.sensel_leak = {0.05, 0.02};
  const double unit = type == SenselType::u16 ? 16 : 1;
  effects.wires = {16, 24, 1e-5 / unit, 2e-5 / unit, 1.5e-5 / unit};
  effects.memory = some_memory();
  effects.residual = {0.02, 0.3};
  effects.pillar_leak = {0.02, 0.005};
  effects.arm_mm = 0.4;
  return effects;
}

/// Two contacts that wander over a skin, noise elsewhere, less in every other frame, and a missing
/// sensel.
class Frames {
 public:
  Frames(SenselType type, double unit, double noise)
      : buffer_(type, kRows, kCols), unit_(unit), noise_(noise) {}

  FrameView frame(int index) {
    switch (buffer_.view().type) {
      case SenselType::u8:
        fill(buffer_.readings<std::uint8_t>(), index);
        break;
      case SenselType::u16:
        fill(buffer_.readings<std::uint16_t>(), index);
        break;
      case SenselType::f32:
        fill(buffer_.readings<float>(), index);
        buffer_.readings<float>()[777] = std::numeric_limits<float>::quiet_NaN();
        break;
    }
    return buffer_.view();
  }

 private:
  template <class Reading>
  void fill(std::span<Reading> readings, int index) {
    std::mt19937 random(static_cast<unsigned>(index));
    std::uniform_real_distribution<double> noise(0, index % 2 == 0 ? noise_ : noise_ / 2);
    for (std::uint32_t row = 0; row < kRows; ++row) {
      for (std::uint32_t col = 0; col < kCols; ++col) {
        const double near = bump(row, col, 8 + index, 20 + 3 * index) +
                            bump(row, col, 30 - 2 * index, 90 - 5 * index);
        readings[row * kCols + col] = static_cast<Reading>(unit_ * (near + noise(random)));
      }
    }
  }

  static double bump(double row, double col, double at_row, double at_col) {
    const double square = (row - at_row) * (row - at_row) + (col - at_col) * (col - at_col);
    return square > 64 ? 0 : 230 * (1 - square / 64);
  }

  FrameBuffer buffer_;
  double unit_;
  double noise_;
};

class SensorEffectsOnDevice : public OnDevice<Path> {
 protected:
  static SolverPlan plan_with(const SensorEffects& effects, bool planes) {
    const SenselType type = GetParam().type;
    SolverPlan plan = planes ? full_plan(kRows, kCols, type, 7) : bare_plan(kRows, kCols, type);
    plan.skin.threshold_counts = type == SenselType::u16 ? 16 * 12 : 12;
    plan.noise_counts = 1;
    plan.calibration.effects = effects;
    return plan;
  }

  static void expect_host_bits(const SolverPlan& plan, bool skip_idle, double noise = 4) {
    const Path& path = GetParam();
    Processor processor(
        test_device(), plan, {.memory = path.memory, .frames_in_flight = kInFlight},
        {.lanes = tested_lanes(path.lanes),
         .paths = {.skip_idle = skip_idle,
                   .stores = path.lanes == 16 ? Stores::streaming : Stores::cached}});
    std::deque<Frames> frames;  // their buffers may be in flight
    std::deque<ForceField> expected;
    HostReference host(plan);
    const auto expect_next = [&] {
      expect_same_planes(processor.receive(), expected.front().view());
      expected.pop_front();
    };
    for (int index = 0; index < kFrames; ++index) {
      if (frames.size() == kInFlight) frames.pop_front();
      frames.emplace_back(path.type, path.type == SenselType::u16 ? 16 : 1, noise);
      const FrameView frame = frames.back().frame(index % 8);
      processor.submit(frame);
      expected.emplace_back(host.solve(frame));
      if (processor.in_flight() == kInFlight) expect_next();
    }
    while (!expected.empty()) expect_next();
  }
};

/// Patterns of a bent skin.
void add_patterns(SolverPlan& plan, double spread) {
  std::mt19937 random(3);
  std::normal_distribution<float> value(0, static_cast<float>(spread));
  for (auto* plane :
       {&plan.calibration.bend_x, &plan.calibration.bend_y, &plan.calibration.bend_xy}) {
    plane->resize(plan.skin.sensels());
    for (float& each : *plane) each = value(random);
  }
}

/// An effect with what stands beside it.
struct EffectCase {
  const char* name;
  void (*set)(SolverPlan& plan, double unit);
  bool planes = false;
  double noise = 4;  ///< 12.99: just below the threshold
  bool skip_idle = true;
};

WireCrosstalk some_wires(double per_count, TareOrigin tares = TareOrigin::conductance) {
  return {16, 24, per_count, per_count, per_count, tares};
}

/// Tares that are an offset leave the wires' bound of idle tiles; a bent skin and a followed
/// baseline change activation thresholds before the wires are found.
constexpr EffectCase kEffects[] = {
    {"curve", [](auto& p, double) { p.calibration.effects.curve = some_curve(p.sensel_type); }},
    {"leak",
     [](auto& p, double) {
       p.calibration.effects.sensel_leak = {0.08, 0.03};
     }},
    {"leak",
     [](auto& p, double) {
       p.calibration.effects.sensel_leak = {0.08, 0.03};
     },
     true},
    {"memory", [](auto& p, double) { p.calibration.effects.memory = some_memory(); }},
    {"memory", [](auto& p, double) { p.calibration.effects.memory = some_memory(); }, false, 4,
     false},
    {"wires",
     [](auto& p, double unit) {
       p.calibration.effects.wires = {16, 24, 1e-5 / unit, 2e-5 / unit, 1.5e-5 / unit};
     },
     true},
    {"a tile of more columns than work-items",
     [](auto& p, double unit) {
       p.calibration.effects.wires = {16, 96, 1e-5 / unit, 2e-5 / unit, 1.5e-5 / unit};
     },
     true},
    {"wires before an offset",
     [](auto& p, double unit) {
       p.calibration.effects.wires = some_wires(3e-5 / unit, TareOrigin::offset);
     },
     true, 12.99},
    {"wires of a bent skin",
     [](auto& p, double) {
       p.calibration.effects.wires = some_wires(3e-5, TareOrigin::offset);
       add_patterns(p, 50);
     },
     true, 12.99},
    {"wires below a followed baseline",
     [](auto& p, double) {
       p.calibration.effects.wires = some_wires(3e-5);
       p.baseline_rate = 0.05;
     },
     true, 12.99},
    {"bending", [](auto& p, double unit) { add_patterns(p, 50 * unit); }, true},
    {"arm", [](auto& p, double) { p.calibration.effects.arm_mm = 0.3; }},
    {"leak between pillars",
     [](auto& p, double) {
       p.calibration.effects.arm_mm = 0.3;
       p.calibration.effects.pillar_leak = {0.03, 0.01};
     }},
};

TEST_P(SensorEffectsOnDevice, EachHasTheBitsOfTheHost) {
  for (const EffectCase& each : kEffects) {
    SCOPED_TRACE(each.name);
    SolverPlan plan = plan_with({}, each.planes);
    each.set(plan, GetParam().type == SenselType::u16 ? 16 : 1);
    expect_host_bits(plan, each.skip_idle, each.noise);
  }
}

/// Readings just below the threshold that the gain of their wires lifts above it, and rows that are
/// refused.
TEST_P(SensorEffectsOnDevice, WiresMakeSenselsActive) {
  SensorEffects effects;
  for (const double per_count : {3e-5, 4e-4}) {
    effects.wires = {16, 24, per_count, per_count, per_count};
    expect_host_bits(plan_with(effects, false), true, 12.99);
  }
}

/// A tile of two columns whose readings lie just below the threshold above a large tare.
TEST(SensorEffects, WiresOfANarrowTileMakeSenselsActive) {
  SolverPlan plan = bare_plan(16, 66, SenselType::f32);
  plan.skin.threshold_counts = 12;
  plan.calibration.tare.assign(plan.skin.sensels(), 1000);
  plan.calibration.effects.wires = {16, 64, 1e-7, 1e-5, 1e-3};
  FrameBuffer frame(SenselType::f32, 16, 66);
  for (const std::size_t i : {4UL * 66 + 64, 4UL * 66 + 65, 5UL * 66 + 64, 5UL * 66 + 65}) {
    frame.readings<float>()[i] = 1004;
  }
  const ForceField expected = solve_on_host(plan, frame.view());
  EXPECT_EQ(expected.status[2 * 33 + 32], status::kUsable);
  for (const int lanes : {1, 16}) {
    Processor processor(test_device(), plan, {}, {.lanes = tested_lanes(lanes)});
    for (int repeated = 0; repeated < 3; ++repeated) {
      processor.submit(frame.view());
      expect_same_bits(processor.receive(), expected.view());
    }
  }
}

/// A contact in the tile of an infinite reading, and without skipping idle blocks.
TEST(SensorEffects, AnInfiniteReadingBehindWiresMakesNoOtherIdle) {
  SolverPlan plan = bare_plan(16, 48, SenselType::f32);
  plan.skin.threshold_counts = 12;
  plan.calibration.effects.wires = {16, 48, 1e-5, 1e-5, 1e-5};
  FrameBuffer frame(SenselType::f32, 16, 48);
  for (const int lanes : {1, 4}) {
    for (const float infinity : {1.0F, -1.0F}) {
      std::ranges::fill(frame.readings<float>(), 0.0F);
      for (std::size_t i = 0; i < 24; ++i) frame.readings<float>()[(8 + i / 12) * 48 + i % 12] = 60;
      frame.readings<float>()[2 * 48 + 30] = infinity * std::numeric_limits<float>::infinity();
      std::vector<ForceField> results;
      for (const bool skip_idle : {false, true}) {
        Processor processor(test_device(), plan, {},
                            {.lanes = tested_lanes(lanes), .paths = {.skip_idle = skip_idle}});
        processor.submit(frame.view());
        results.emplace_back(processor.receive());
      }
      EXPECT_EQ(results[0].status[std::size_t{4} * 24], status::kUsable);
      expect_same_bits(results[1].view(), results[0].view());
    }
  }
}

/// A contact that jumps along rows of up to 38 blocks: runs of idle blocks, skipped together, begin
/// and end anywhere.
TEST_P(SensorEffectsOnDevice, RunsOfIdleBlocksKeepTheBitsOfTheHost) {
  constexpr std::uint32_t kPillars = 307;
  SolverPlan plan = bare_plan(12, 2 * kPillars, GetParam().type);
  plan.skin.threshold_counts = 12;
  plan.noise_counts = 1;
  plan.calibration.effects.arm_mm = 0.3;
  plan.calibration.effects.pillar_leak = {0.03, 0.01};
  Processor processor(test_device(), plan, {.memory = GetParam().memory},
                      {.lanes = tested_lanes(GetParam().lanes), .paths = {.skip_idle = true}});
  FrameBuffer buffer(plan.sensel_type, 12, 2 * kPillars);
  const auto press = [&](auto readings, std::uint32_t first) {
    std::fill(readings.begin(), readings.end(), 0);
    for (std::uint32_t row = 2; row < 10; ++row) {
      for (std::uint32_t col = first; col < first + 10; ++col) {
        const auto reading = 20 + 7 * (row * col % 13);
        readings[row * 2 * kPillars + col] =
            static_cast<std::remove_reference_t<decltype(readings[0])>>(reading);
      }
    }
  };
  for (std::uint32_t index = 0; index < 24; ++index) {
    const std::uint32_t first = index * 131 % (2 * kPillars - 10);
    if (plan.sensel_type == SenselType::u8) {
      press(buffer.readings<std::uint8_t>(), first);
    } else {
      press(buffer.readings<float>(), first);
    }
    SCOPED_TRACE(index);
    processor.submit(buffer.view());
    expect_same_bits(processor.receive(), solve_on_host(plan, buffer.view()).view());
  }
}

/// Every path is compiled once, with everything.
class AllEffectsOnDevice : public SensorEffectsOnDevice {};

TEST_P(AllEffectsOnDevice, AllTogetherHaveTheBitsOfTheHost) {
  SolverPlan plan = plan_with(all_effects(GetParam().type), true);
  plan.uncertainty = true;
  expect_host_bits(plan, true);
}

constexpr Path kWide = {SenselType::u8, 16, Memory::shared};
constexpr Path kSingle = {SenselType::f32, 1, Memory::staged};
INSTANTIATE_TEST_SUITE_P(Device, SensorEffectsOnDevice, testing::Values(kWide), name_of_path);
INSTANTIATE_TEST_SUITE_P(FurtherDevice, SensorEffectsOnDevice, testing::Values(kSingle),
                         name_of_path);
INSTANTIATE_TEST_SUITE_P(Device, AllEffectsOnDevice,
                         testing::Values(kWide, kSingle, Path{SenselType::u16, 4, Memory::staged}),
                         name_of_path);
INSTANTIATE_TEST_SUITE_P(FurtherDevice, AllEffectsOnDevice,
                         testing::Values(Path{SenselType::u8, 1, Memory::staged},
                                         Path{SenselType::f32, 16, Memory::staged},
                                         Path{SenselType::f32, 8, Memory::shared}),
                         name_of_path);

}  // namespace
}  // namespace pillarfield
