#include "report/field/sweep_times.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <ctime>
#include <numeric>

#include "pillarfield/contact_tracker.h"
#include "pillarfield/processor.h"
#include "pillarfield/scene.h"
#include "pillarfield/simulator.h"

namespace pillarfield::report {
namespace {

using field_study::Observed;
using field_study::Scene;

constexpr std::uint32_t kTile = 192;  // sensels a side, enough for any contact
constexpr std::uint32_t kTilesASide = 4;
constexpr int kRounds = 40;

/// Copies a frame into a tile of a larger one; what does not fit is left out.
void paste(const FrameBuffer& frame, const Skin& skin, FrameBuffer& into, std::uint32_t tile) {
  const std::size_t width = std::size_t{kTile} * kTilesASide;
  const std::size_t top = std::size_t{tile / kTilesASide} * kTile;
  const std::size_t left = std::size_t{tile % kTilesASide} * kTile;
  const auto from = frame.readings<float>();
  const auto to = into.readings<float>();
  const std::size_t cols = std::min(skin.cols, kTile);
  for (std::size_t row = 0; row < std::min(skin.rows, kTile); ++row) {
    std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(row * skin.cols), cols,
                to.begin() + static_cast<std::ptrdiff_t>((top + row) * width + left));
  }
}

/// What solving a frame took, round by round.
struct Costs {
  std::vector<double> seconds;
  std::vector<double> clocks;  ///< of the processor

  void add(const Costs& others) {
    seconds.insert(seconds.end(), others.seconds.begin(), others.seconds.end());
    clocks.insert(clocks.end(), others.clocks.begin(), others.clocks.end());
  }
};

/// Follows the contacts of the result too, where there is a tracker.
Costs cost_of(Processor& processor, const FrameBuffer& frame, ContactTracker* tracker = nullptr) {
  const std::clock_t clock = std::clock();
  const auto begin = std::chrono::steady_clock::now();
  processor.submit(frame.view());
  const ForceFieldView forces = processor.receive();
  if (tracker != nullptr) tracker->update(forces, 0, processor.contacts());
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  return {{taken.count()}, {static_cast<double>(std::clock() - clock)}};
}

/// The two orders of a round have different times: a median would fall between them.
double mean_of_middle_half(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  const auto quarter = static_cast<std::ptrdiff_t>(times.size() / 4);
  const double sum = std::accumulate(times.begin() + quarter, times.end() - quarter, 0.0);
  return sum / static_cast<double>(times.end() - times.begin() - 2 * quarter);
}

/// Of `plan`, with its contacts if so wished, over its direct solve.
OverDirect measure(const Device& device, const SolverPlan& plan, const FrameBuffer& frame,
                   bool contacts = false) {
  ContactTracker contact_tracker(plan.skin.pillar_pitch_mm());
  ContactTracker* const tracker = contacts ? &contact_tracker : nullptr;
  SolverPlan direct_plan = plan;
  direct_plan.estimator = Estimator::direct;
  Processor field(device, plan);
  Processor direct(device, direct_plan);
  Costs field_costs;
  Costs direct_costs;
  for (int round = -4; round < kRounds; ++round) {
    // Who comes second finds the frame in the caches.
    const bool field_first = round % 2 == 0;
    Costs by_field;
    if (field_first) by_field = cost_of(field, frame, tracker);
    const Costs by_direct = cost_of(direct, frame);
    if (!field_first) by_field = cost_of(field, frame, tracker);
    if (round < 0) continue;
    field_costs.add(by_field);
    direct_costs.add(by_direct);
  }
  return {mean_of_middle_half(field_costs.seconds) / mean_of_middle_half(direct_costs.seconds),
          mean_of_middle_half(field_costs.clocks) / mean_of_middle_half(direct_costs.clocks)};
}

/// The plan's sensor in one frame of 16 contacts.
struct Tiled {
  FrameBuffer frame;
  SolverPlan plan;
  double contact_share;
};

Tiled tiled(const std::vector<Scene>& scenes) {
  constexpr std::uint32_t kTiles = kTilesASide * kTilesASide;
  constexpr std::uint32_t kSide = kTile * kTilesASide;
  Tiled tiled{FrameBuffer(SenselType::f32, kSide, kSide), {}, 0};
  const std::size_t step = std::max<std::size_t>(1, scenes.size() / kTiles);
  double loaded = 0;
  for (std::uint32_t tile = 0; tile < kTiles; ++tile) {
    const Scene& scene = scenes[tile * step % scenes.size()];
    const Observed observed(scene);
    paste(observed.frame(), observed.plan().skin, tiled.frame, tile);
    tiled.plan = field_study::plan_of(scene, observed, field_study::methods().front());
    loaded += static_cast<double>(observed.score(observed.direct()).loaded);
  }
  tiled.plan.skin.rows = tiled.plan.skin.cols = kSide;
  tiled.plan.uncertainty = false;
  tiled.contact_share = loaded / static_cast<double>(tiled.plan.skin.pillars());
  return tiled;
}

void measure_square_metre(const Device& device, const std::filesystem::path& path,
                          SweepTimes& times) {
  const Simulator simulator(load_scene(path));
  SolverPlan plan;
  plan.skin = simulator.scene().skin;
  plan.sensel_type = simulator.sensel_type();
  plan.calibration = simulator.calibration();
  set_solver(plan, simulator.scene());
  plan.estimator = Estimator::field;
  FrameBuffer frame(plan.sensel_type, plan.skin.rows, plan.skin.cols);
  ForceField truth(plan.skin.pillar_rows(), plan.skin.pillar_cols());
  simulator.render(simulator.scene().frames / 2, frame, truth);
  times.square_metre = measure(device, plan, frame);
  times.square_metre_with_contacts = measure(device, plan, frame, true);
  const auto loaded = std::count_if(truth.status.begin(), truth.status.end(),
                                    [](std::uint8_t bits) { return bits != 0; });
  times.square_metre_share = static_cast<double>(loaded) / static_cast<double>(truth.pillars());
}

}  // namespace

SweepTimes measure_sweep_times(const std::vector<Scene>& scenes,
                               const std::filesystem::path& square_metre) {
  auto [frame, plan, contact_share] = tiled(scenes);
  const Device device = open_device();
  SweepTimes times;
  times.device = device.info().name;
  times.contact_share = contact_share;
  for (std::size_t i = 0; i < kSweeps.size(); ++i) {
    plan.field.sweeps = kSweeps[i];
    times.over_direct[i] = measure(device, plan, frame);
  }
  plan.field.shape = false;
  times.without_shape = measure(device, plan, frame);
  measure_square_metre(device, square_metre, times);
  return times;
}

}  // namespace pillarfield::report
