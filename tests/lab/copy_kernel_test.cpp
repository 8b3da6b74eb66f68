// The copy kernels read every input byte and write every output byte of a plan's solve.

#include "bench/timing/copy_kernel.h"

#include <gtest/gtest.h>

#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "bench/variants.h"
#include "tests/device/test_device.h"

namespace pillarfield::bench {
namespace {

/// A copy kernel whose inputs can be changed bit by bit.
class Copy {
 public:
  Copy(const SolverPlan& plan, const CopyKind& kind)
      : plan_(plan),
        frames_(plan.skin, plan.sensel_type, {}),
        kernel_(test_device(), plan, frames_, kind, 1),
        queue_(kernel_.device().context, kernel_.device().device) {}

  /// The output for the first frame.
  std::vector<std::byte> of_first_frame() {
    // Each run continues the series of frames.
    kernel_.run(copied_ == 0 ? 1 : static_cast<int>(frames_.size()));
    ++copied_;
    return kernel_.results();
  }

  /// Flips the lowest bit of a byte, which is the lowest bit of its value: devices are
  /// little-endian.
  void flip(const cl::Buffer& buffer, std::size_t byte) {
    std::uint8_t value = 0;
    queue_.enqueueReadBuffer(buffer, CL_TRUE, byte, 1, &value);
    value ^= 1;
    queue_.enqueueWriteBuffer(buffer, CL_TRUE, byte, 1, &value);
  }

  CopyKernel& kernel() { return kernel_; }
  [[nodiscard]] const SolverPlan& plan() const { return plan_; }

 private:
  SolverPlan plan_;
  Frames frames_;
  CopyKernel kernel_;
  cl::CommandQueue queue_;
  int copied_ = 0;
};

/// Number of differing values of `size` bytes, from byte `first`, in one row of pillars and
/// elsewhere.
struct Moved {
  int in_row = 0;
  int elsewhere = 0;
};
Moved moved(const std::vector<std::byte>& before, const std::vector<std::byte>& after,
            std::size_t first, std::size_t size, const Skin& skin, std::size_t row) {
  Moved count;
  for (std::size_t i = 0; i < skin.pillars(); ++i) {
    const std::size_t byte = first + i * size;
    if (std::memcmp(&before[byte], &after[byte], size) == 0) continue;
    ++(i / skin.pillar_cols() == row ? count.in_row : count.elsewhere);
  }
  return count;
}

/// Expects that one bit of a sensel changes exactly one value of each plane, in the pillar's row.
void expect_all_moved(Copy& copy, const cl::Buffer& input, std::size_t first_byte,
                      std::size_t value_size) {
  const Skin& skin = copy.plan().skin;
  const std::size_t pillars = skin.pillars();
  for (const std::size_t pillar : {std::size_t{0}, pillars / 2, pillars - 1}) {
    const std::size_t row = pillar / skin.pillar_cols();
    const std::size_t col = pillar % skin.pillar_cols();
    for (std::size_t sensel = 0; sensel < 4; ++sensel) {
      const auto before = copy.of_first_frame();
      const std::size_t at = (2 * row + sensel / 2) * skin.cols + 2 * col + sensel % 2;
      copy.flip(input, first_byte + at * value_size);
      const auto after = copy.of_first_frame();
      const std::size_t status = before.size() - pillars;
      constexpr std::size_t kSize = sizeof(float);
      for (std::size_t plane = 0; plane <= status; plane += kSize * pillars) {
        const Moved count = moved(before, after, plane, plane == status ? 1 : kSize, skin, row);
        ASSERT_EQ(count.in_row, 1) << "sensel " << sensel << " of pillar " << pillar;
        ASSERT_EQ(count.elsewhere, 0) << "sensel " << sensel << " of pillar " << pillar;
      }
    }
  }
}

/// 53 pillars a row: rows begin anywhere in a cache line and end with a partial block.
Skin odd_skin() {
  Skin skin;
  skin.rows = 10;
  skin.cols = 2 * 53 + 1;
  return skin;
}

class EveryCopy : public testing::TestWithParam<std::tuple<SenselType, CopyKind>> {
 protected:
  static SolverPlan plan(std::string_view stage) {
    SolverPlan plan;
    plan.skin = odd_skin();
    plan.sensel_type = std::get<SenselType>(GetParam());
    add_stage(plan, stage);
    return plan;
  }
  static CopyKind kind() { return std::get<CopyKind>(GetParam()); }
};

TEST_P(EveryCopy, EverySenselMovesEveryResult) {
  for (const char* const stage : {"none", "all"}) {
    Copy copy(plan(stage), kind());
    expect_all_moved(copy, copy.kernel().frame(0), 0, size_of(copy.plan().sensel_type));
  }
}

TEST_P(EveryCopy, EveryCalibrationPlaneMovesEveryResult) {
  SolverPlan all = plan("all");
  all.calibration.noise.assign(all.skin.sensels(), 1);
  Copy copy(all, kind());
  const Streams streams = streams_of(all);
  ASSERT_EQ(streams.calibration_planes, 4);
  for (int i = 0; i < streams.calibration_planes; ++i) {
    const std::size_t pitch = plane_pitch(all.skin.sensels()) * sizeof(float);
    expect_all_moved(copy, copy.kernel().calibration(), static_cast<std::size_t>(i) * pitch, 4);
  }
  expect_all_moved(copy, copy.kernel().mask(), 0, 1);
}

TEST_P(EveryCopy, TareThatFollowsIsWritten) {
  Copy copy(plan("baseline"), kind());
  const OpenedDevice& opened = copy.kernel().device();
  const cl::CommandQueue queue(opened.context, opened.device);
  const auto tare = [&] {
    std::vector<std::uint32_t> values(copy.plan().skin.sensels());
    queue.enqueueReadBuffer(copy.kernel().calibration(), CL_TRUE, 0, 4 * values.size(),
                            values.data());
    return values;
  };
  const auto before = tare();
  copy.of_first_frame();
  const auto after = tare();
  const std::size_t cols = copy.plan().skin.cols;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const bool under_a_pillar = i % cols + 1 < cols;
    EXPECT_EQ(before[i] != after[i], under_a_pillar) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Copies, EveryCopy,
                         testing::Combine(testing::Values(SenselType::u8, SenselType::u16,
                                                          SenselType::f32),
                                          testing::ValuesIn(kCopyKinds)),
                         [](const auto& copy) {
                           return std::string(name_of(std::get<SenselType>(copy.param))) + "_" +
                                  std::get<CopyKind>(copy.param).name;
                         });

TEST(Streams, BytesAreThoseOfThePlan) {
  SolverPlan plan = bare_plan(8);
  EXPECT_EQ(streams_of(plan).bytes_per_pillar(), 4U + 12 + 1);
  add_stage(plan, "all");
  // Tare, gain and dead zone (four floats each), mask; three forces, three angles, nine of
  // uncertainty.
  EXPECT_EQ(streams_of(plan).bytes_per_pillar(), 4U + 3 * 16 + 4 + (3 + 3 + 9) * 4 + 1);
  SolverPlan following = bare_plan(8, SenselType::f32);
  add_stage(following, "baseline");
  EXPECT_EQ(streams_of(following).bytes_per_pillar(), 16U + 2 * 16 + 12 + 1);
}

}  // namespace
}  // namespace pillarfield::bench
