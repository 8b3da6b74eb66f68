#include "pillarfield/untouched_skin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/random.h"
#include "pillarfield/error.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/status.h"

namespace pillarfield {
namespace {

constexpr std::size_t kLeastPillars = 20000;
/// A step is refused if it multiplies a share by this: a low threshold may be meant.
constexpr double kMuchMore = 2;

/// Fills a frame with tare + noise.
void render_untouched(const Calibration& planes, std::uint64_t index, FrameBuffer& frame) {
  const std::size_t cols = frame.view().cols;
  std::vector<float> normal(cols);
  const auto readings = frame.readings<float>();
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (i % cols == 0) {
      random::fill_normal({0, random::Stream::noise, index, static_cast<std::uint32_t>(i / cols)},
                          normal);
    }
    const float tare = planes.tare.empty() ? 0 : planes.tare[i];
    readings[i] = tare + planes.noise[i] * normal[i % cols];
  }
}

}  // namespace

double untouched_share(const SkinCalibration& calibration) {
  if (calibration.planes.noise.empty() || !calibration.threshold_counts) return 0;
  SolverPlan plan;
  plan.skin.rows = calibration.rows;
  plan.skin.cols = calibration.cols;
  plan.skin.layout = calibration.layout.value_or(plan.skin.layout);
  plan.skin.falling = calibration.falling;
  plan.sensel_type = SenselType::f32;
  apply(calibration, plan.skin, plan.calibration);
  plan.calibration.effects.wires.reset();  // Tares and noise are without their crosstalk.
  const std::size_t frames = 1 + kLeastPillars / std::max<std::size_t>(1, plan.skin.elements());
  FrameBuffer frame(plan.sensel_type, plan.skin.rows, plan.skin.cols);
  std::size_t touched = 0;
  for (std::size_t i = 0; i < frames; ++i) {
    render_untouched(calibration.planes, i, frame);
    const ForceField field = solve_on_host(plan, frame.view());
    touched += static_cast<std::size_t>(std::ranges::count_if(
        field.status, [](std::uint8_t bits) { return (bits & status::kUsable) != 0; }));
  }
  return static_cast<double>(touched) / static_cast<double>(frames * plan.skin.elements());
}

void require_untouched_idle(const SkinCalibration& before, const SkinCalibration& after,
                            std::string_view step) {
  const double share = untouched_share(after);
  if (share <= kMostUntouched || share <= kMuchMore * untouched_share(before)) return;
  throw Error(step,
              fmt::format("{:.2f} % of the pillars of the untouched skin would seem touched, more "
                          "than {:g} %",
                          100 * share, 100 * kMostUntouched),
              "take the tare with a higher threshold factor, or give frames that determine small "
              "readings better");
}

}  // namespace pillarfield
