// Results of half precision: those of single precision, rounded, on every kind of path.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include "device/device_state.h"
#include "pillarfield/error.h"
#include "pillarfield/processor.h"
#include "pillarfield/tuning.h"
#include "random_plan.h"
#include "tests/device/test_device.h"

namespace pillarfield {
namespace {

void expect_rounded(std::span<const Half> halves, std::span<const float> floats,
                    const char* plane) {
  ASSERT_EQ(halves.size(), floats.size()) << plane;
  for (std::size_t i = 0; i < halves.size(); ++i) {
    ASSERT_EQ(halves[i].bits, to_half(floats[i]).bits)
        << plane << " of pillar " << i << ": " << to_float(halves[i]) << " is not " << floats[i];
  }
}

void expect_rounded(const HalfFieldView& half, const ForceFieldView& single) {
  ASSERT_EQ(half.rows, single.rows);
  ASSERT_EQ(half.cols, single.cols);
  expect_rounded(half.shear_x, single.shear_x, "shear_x");
  expect_rounded(half.shear_y, single.shear_y, "shear_y");
  expect_rounded(half.normal, single.normal, "normal");
  ASSERT_TRUE(std::ranges::equal(half.status, single.status));
  expect_rounded(half.magnitude, single.magnitude, "magnitude");
  expect_rounded(half.theta, single.theta, "theta");
  expect_rounded(half.phi, single.phi, "phi");
  for (std::size_t index = 0; index < kUncertaintyPlanes; ++index) {
    const auto which = static_cast<Uncertainty>(index);
    expect_rounded(half.uncertainty[which], single.uncertainty[which], name_of(which));
  }
}

SolverPlan in_halves(SolverPlan plan) {
  plan.half_output = true;
  return plan;
}

/// Every half, the borders between neighbours and the floats beside these, both signs; infinities,
/// NaN, the ends of single precision; and random bits up to a whole number of 16 floats.
std::vector<float> hard_values() {
  using Limits = std::numeric_limits<float>;
  std::vector<float> values = {0,
                               Limits::denorm_min(),
                               Limits::min(),
                               Limits::max(),
                               Limits::infinity(),
                               Limits::quiet_NaN(),
                               65520,
                               std::nextafter(65520.0F, 0.0F)};
  for (std::uint16_t bits = 0; bits < 0x7bff; ++bits) {
    const float half = to_float({bits});
    const float border = (half + to_float({static_cast<std::uint16_t>(bits + 1)})) / 2;
    values.insert(values.end(), {half, std::nextafter(border, 0.0F), border,
                                 std::nextafter(border, Limits::infinity())});
  }
  const std::size_t positive = values.size();
  for (std::size_t i = 0; i < positive; ++i) values.push_back(-values[i]);
  std::mt19937 random(1);
  while (values.size() % 16 != 0 || values.size() < 400'000) {
    values.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(random())));
  }
  return values;
}

/// As solve_frame stores, but of given values; the last block of two has one lane less.
constexpr const char* kStoreValues = R"(
kernel void store_values(global const float* values, global Result* results) {
  const size_t first = get_global_id(0) * PF_LANES;
#if PF_LANES == 1
  const Lanes lanes = {0, 1};
  store_plane(values[first], results + first, lanes);
#else
  const Lanes lanes = {0, get_global_id(0) % 2 == 0 ? PF_LANES : PF_LANES - 1};
  store_plane(PF_VLOAD(0, values + first), results + first, lanes);
#endif
}
)";

/// What the first lines of a program may say: whether the processor's own instruction rounds, where
/// it has one, or bits_of_half.
class HalfOutputRounding : public testing::TestWithParam<const char*> {};

TEST_P(HalfOutputRounding, IsThatOfTheHost) {
  std::vector<float> values = hard_values();
  Device::State& device = test_device().state();
  const cl::CommandQueue queue(device.context, device.device);
  const cl::Buffer from(device.context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR,
                        values.size() * sizeof(float), values.data());
  const SolverPlan plan = in_halves(bare_plan(8, 64, SenselType::u8));
  for (const int lanes : {1, 2, 4, 8, 16}) {
    cl::Kernel kernel(device.program(GetParam() + kernel_source(plan, lanes) + kStoreValues),
                      "store_values");
    constexpr std::uint16_t kUntouched = 0x1234;
    std::vector<Half> halves(values.size(), Half{kUntouched});
    const std::size_t bytes = halves.size() * sizeof(Half);
    const cl::Buffer to(device.context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, bytes,
                        halves.data());
    kernel.setArg(0, from);
    kernel.setArg(1, to);
    const auto width = static_cast<std::size_t>(lanes);
    queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(values.size() / width));
    queue.enqueueReadBuffer(to, CL_TRUE, 0, bytes, halves.data());
    for (std::size_t i = 0; i < values.size(); ++i) {
      const bool left_out = lanes > 1 && i % (2 * width) == 2 * width - 1;
      ASSERT_EQ(halves[i].bits, left_out ? kUntouched : to_half(values[i]).bits)
          << values[i] << " with " << lanes << " lanes";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Instructions, HalfOutputRounding, testing::Values("", "#undef __F16C__\n"),
                         [](const auto& first_lines) {
                           return first_lines.index == 0 ? "OfTheDevice" : "Plain";
                         });

struct Path {
  SenselType type;
  int lanes;
  Memory memory;
};

std::string name_of_path(const testing::TestParamInfo<Path>& path) {
  return std::string(name_of(path.param.type)) + "_lanes" + std::to_string(path.param.lanes) +
         (path.param.memory == Memory::shared ? "_shared" : "_staged");
}

class HalfOutputPaths : public testing::TestWithParam<Path> {
 protected:
  void SetUp() override {
    if (GetParam().memory == Memory::shared && !test_device().info().shares_memory) {
      GTEST_SKIP() << "this device does not share the host's memory";
    }
  }

  /// Solves random frames of `plan` both ways.
  static void expect_rounded_results(const SolverPlan& plan) {
    const Processor::Options options = {.memory = GetParam().memory};
    const ProcessorTuning tuning = {.lanes = GetParam().lanes};
    Processor single(test_device(), plan, options, tuning);
    Processor half(test_device(), in_halves(plan), options, tuning);
    for (std::uint32_t seed = 0; seed < 3; ++seed) {
      const RandomFrame frame(plan, 3, seed);
      single.submit(frame.view());
      half.submit(frame.view());
      expect_rounded(half.receive_half(), single.receive());
    }
  }
};

TEST_P(HalfOutputPaths, BareResultsAreRounded) {
  expect_rounded_results(bare_plan(34, 2 * 53, GetParam().type));
  expect_rounded_results(bare_plan(3, 3, GetParam().type));
}

TEST_P(HalfOutputPaths, ResultsOfAllStagesAreRounded) {
  SolverPlan plan = full_plan(15, 2 * 39 + 1, GetParam().type, 7);
  plan.angles = true;
  plan.uncertainty = true;
  expect_rounded_results(plan);
}

INSTANTIATE_TEST_SUITE_P(Paths, HalfOutputPaths,
                         testing::Values(Path{SenselType::u8, 1, Memory::shared},
                                         Path{SenselType::u8, 16, Memory::shared},
                                         Path{SenselType::u16, 4, Memory::staged},
                                         Path{SenselType::f32, 1, Memory::staged},
                                         Path{SenselType::f32, 4, Memory::shared},
                                         Path{SenselType::f32, 16, Memory::staged}),
                         name_of_path);

/// A frame with a square contact whose corner is at (at, at), and silence elsewhere.
FrameBuffer touched_frame(const Skin& skin, std::uint32_t at) {
  FrameBuffer frame(SenselType::u8, skin.rows, skin.cols);
  for (std::uint32_t row = at; row < at + 20; ++row) {
    for (std::uint32_t col = at; col < at + 20; ++col) {
      frame.bytes()[std::size_t{row} * skin.cols + col] = static_cast<std::byte>(row + 3 * col);
    }
  }
  return frame;
}

TEST(HalfOutput, ContactsThatMoveLeaveSilenceBehind) {
  const SolverPlan plan = bare_plan(80, 2 * 101, SenselType::u8);
  Processor all(test_device(), plan, {}, {.paths = {.skip_silent = false}});
  Processor half(test_device(), in_halves(plan), {.frames_in_flight = 2});
  for (std::uint32_t at = 0; at < 60; at += 7) {
    const FrameBuffer frame = touched_frame(plan.skin, at);
    all.submit(frame.view());
    half.submit(frame.view());
    expect_rounded(half.receive_half(), all.receive());
  }
}

TEST(HalfOutput, BothPrecisionsHaveAReceiveOfTheirOwn) {
  const SolverPlan plan = bare_plan(8, 8, SenselType::u8);
  const RandomFrame frame(plan, 0, 1);
  Processor single(test_device(), plan);
  single.submit(frame.view());
  EXPECT_THROW(static_cast<void>(single.receive_half()), Error);
  Processor half(test_device(), in_halves(plan));
  half.submit(frame.view());
  EXPECT_THROW(static_cast<void>(half.receive()), Error);
  expect_rounded(half.receive_half(), single.receive());
  EXPECT_THROW(static_cast<void>(half.receive_half()), Error) << "none is in flight";
}

}  // namespace
}  // namespace pillarfield
