// What the estimator `contact` costs.

#include "report/field/cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <ctime>
#include <numeric>
#include <vector>

#include "pillarfield/contact_tracker.h"
#include "pillarfield/processor.h"
#include "pillarfield/scene.h"
#include "pillarfield/simulator.h"
#include "pillarfield/status.h"
#include "report/field/section.h"

namespace pillarfield::report {
namespace {

constexpr int kRounds = 40;

/// What solving a frame took, round by round.
struct Costs {
  std::vector<double> seconds;
  std::vector<double> clocks;  ///< of the processor
};

/// Follows the contacts of the result too, where there is a tracker.
void add_cost(Processor& processor, const FrameBuffer& frame, ContactTracker* tracker,
              Costs& costs) {
  const std::clock_t clock = std::clock();
  const auto begin = std::chrono::steady_clock::now();
  processor.submit(frame.view());
  const ForceFieldView forces = processor.receive();
  if (tracker != nullptr) tracker->update(forces, 0, processor.contacts());
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  costs.seconds.push_back(taken.count());
  costs.clocks.push_back(static_cast<double>(std::clock() - clock));
}

/// The two orders of a round have different times: a median would fall between them.
double mean_of_middle_half(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  const auto quarter = static_cast<std::ptrdiff_t>(times.size() / 4);
  const double sum = std::accumulate(times.begin() + quarter, times.end() - quarter, 0.0);
  return sum / static_cast<double>(times.end() - times.begin() - 2 * quarter);
}

OverDirect measure(const Device& device, const SolverPlan& plan, const FrameBuffer& frame,
                   ContactTracker* tracker) {
  constexpr int kWarmUps = 4;
  SolverPlan direct_plan = plan;
  direct_plan.estimator = Estimator::direct;
  Processor contact(device, plan);
  Processor direct(device, direct_plan);
  Costs contact_costs;
  Costs direct_costs;
  for (int round = -kWarmUps; round < kRounds; ++round) {
    if (round == 0) contact_costs = direct_costs = {};
    // The second of a round finds the frame in the caches.
    const bool contact_first = round % 2 == 0;
    if (contact_first) add_cost(contact, frame, tracker, contact_costs);
    add_cost(direct, frame, nullptr, direct_costs);
    if (!contact_first) add_cost(contact, frame, tracker, contact_costs);
  }
  return {mean_of_middle_half(contact_costs.seconds) / mean_of_middle_half(direct_costs.seconds),
          mean_of_middle_half(contact_costs.clocks) / mean_of_middle_half(direct_costs.clocks)};
}

void count_pillars(const ForceField& truth, ContactCost& cost) {
  double loaded = 0;
  double open = 0;
  for (const std::uint8_t bits : truth.status) {
    loaded += bits != 0 ? 1 : 0;
    open += region_of(bits) == Region::three ? 1 : 0;
  }
  cost.contact_share = loaded / static_cast<double>(truth.pillars());
  cost.open_share = open / loaded;
}

}  // namespace

ContactCost measure_contact_cost(const std::filesystem::path& scene) {
  const Simulator simulator(load_scene(scene));
  SolverPlan plan;
  plan.skin = simulator.scene().skin;
  plan.sensel_type = simulator.sensel_type();
  plan.calibration = simulator.calibration();
  set_solver(plan, simulator.scene());
  plan.estimator = Estimator::contact;
  FrameBuffer frame(plan.sensel_type, plan.skin.rows, plan.skin.cols);
  ForceField truth(plan.skin.pillar_rows(), plan.skin.pillar_cols());
  simulator.render(simulator.scene().frames / 2, frame, truth);
  const Device device = open_device();
  ContactTracker tracker(plan.skin.pillar_pitch_mm());
  ContactCost cost;
  cost.device = device.info().name;
  count_pillars(truth, cost);
  cost.contact = measure(device, plan, frame, nullptr);
  cost.tracked = measure(device, plan, frame, &tracker);
  return cost;
}

std::string cost_section(const FieldContext& context) {
  const ContactCost& cost = context.cost;
  return fmt::format(
      R"(## Cost

A frame of a square metre ([square_metre.toml](../scenes/square_metre.toml): {:.1f} % of the pillars are in contact, {:.2f} % of these in region 3) on {}, over the direct solve of the
same frame in the same run, in turns, {} rounds:

| | processor time, all threads | time |
|--|--:|--:|
| `direct` | 1 | 1 |
| `contact` | {:.2f} | {:.2f} |
| `contact`, contacts followed by `ContactTracker` | {:.2f} | {:.2f} |
)",
      100 * cost.contact_share, 100 * cost.open_share, cost.device, kRounds, cost.contact.processor,
      cost.contact.time, cost.tracked.processor, cost.tracked.time);
}

}  // namespace pillarfield::report
