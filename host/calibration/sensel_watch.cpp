#include "pillarfield/sensel_watch.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "base/thread_pool.h"
#include "calibration/sensel_judge.h"
#include "pillarfield/error.h"
#include "pillarfield/fault_finder.h"
#include "pillarfield/tuning.h"

namespace pillarfield {
namespace {

using WatchClock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kWatchInterval(50);
constexpr int kWatchDuty = 9;  // The thread rests this many times as long as it works.

SkinCalibration watched_calibration(const SolverPlan& plan) {
  SkinCalibration calibration = blank_calibration(plan.skin);
  calibration.planes = plan.calibration;
  return calibration;
}

}  // namespace

struct SenselWatch::State {
  State(SolverPlan watched, std::chrono::milliseconds window_length)
      : plan(std::move(watched)),
        window(window_length),
        frame(plan.sensel_type, plan.skin.rows, plan.skin.cols),
        faults(plan.skin.sensels()),
        thread([this](const std::stop_token& stop) { run(stop); }) {}

  void run(const std::stop_token& stop);
  void add(std::optional<FaultFinder>& finder, WatchClock::time_point& start);
  [[nodiscard]] SenselHealth judge(const FaultFinder& finder);
  void update_faults(const FaultFinder& finder);
  [[nodiscard]] bool is_still(const SenselStatistics& sensel, std::size_t index) const;
  [[nodiscard]] bool drifts(const SenselStatistics& sensel, std::size_t index) const;

  SolverPlan plan;
  std::chrono::milliseconds window;
  FrameBuffer frame;                 ///< of the thread while `is_full`
  std::vector<std::uint8_t> faults;  ///< per sensel: 0, 1 dead, 2 stuck
  mutable std::mutex mutex;
  std::condition_variable_any changed;
  std::atomic<bool> is_ready = false;  ///< for a frame
  bool is_full = false;
  std::optional<SolverPlan> new_plan;
  SenselHealth published;
  std::jthread thread;
};

void SenselWatch::State::run(const std::stop_token& stop) {
  yield_to_other_threads();
  std::optional<FaultFinder> finder;
  WatchClock::time_point start;
  while (!stop.stop_requested()) {
    std::unique_lock lock(mutex);
    is_ready = true;
    if (!changed.wait(lock, stop, [&] { return is_full || new_plan; })) return;
    if (new_plan) {
      plan = *std::exchange(new_plan, std::nullopt);
      finder.reset();
      continue;
    }
    lock.unlock();
    const auto before = WatchClock::now();
    add(finder, start);
    const auto rest =
        std::max<WatchClock::duration>(kWatchInterval, kWatchDuty * (WatchClock::now() - before));
    lock.lock();
    is_full = false;
    changed.wait_for(lock, stop, rest, [] { return false; });
  }
}

void SenselWatch::State::add(std::optional<FaultFinder>& finder, WatchClock::time_point& start) {
  if (!finder) {
    finder.emplace("health", plan.skin, plan.sensel_type, watched_calibration(plan));
    start = WatchClock::now();
  }
  finder->add(frame.view());
  if (WatchClock::now() - start < window || finder->statistics().frames() < kLeastFaultFrames) {
    return;
  }
  const SenselHealth found = judge(*finder);
  finder.reset();
  const std::scoped_lock lock(mutex);
  published = found;
}

SenselHealth SenselWatch::State::judge(const FaultFinder& finder) {
  update_faults(finder);
  SenselHealth health;
  const auto sensels = finder.statistics().sensels();
  for (std::size_t i = 0; i < sensels.size(); ++i) {
    if (!plan.calibration.mask.empty() && plan.calibration.mask[i] != kGood) continue;
    if (faults[i] == 1) ++health.dead;
    if (faults[i] == 2) ++health.stuck;
    if (faults[i] == 0 && drifts(sensels[i], i)) ++health.drifting;
  }
  return health;
}

/// Sensels that moved are sound; those that the window shows to be faulty are not.
void SenselWatch::State::update_faults(const FaultFinder& finder) {
  const auto sensels = finder.statistics().sensels();
  for (std::size_t i = 0; i < sensels.size(); ++i) {
    if (!is_still(sensels[i], i)) faults[i] = 0;
  }
  try {
    for (const SenselFinding& finding : finder.result().findings) {
      if (!finding.masked) continue;
      faults[std::size_t{finding.row} * plan.skin.cols + finding.col] =
          finding.fault == SenselFault::stuck ? 2 : 1;
    }
  } catch (const Error&) {
    // Nothing moved in this window, so that it tests no sensel.
  }
}

bool SenselWatch::State::is_still(const SenselStatistics& sensel, std::size_t index) const {
  const double noise =
      plan.calibration.noise.empty() ? reading_noise(plan) : plan.calibration.noise[index];
  return pillarfield::is_still(sensel, noise);
}

bool SenselWatch::State::drifts(const SenselStatistics& sensel, std::size_t index) const {
  const double tare = plan.calibration.tare.empty() ? 0 : plan.calibration.tare[index];
  const double limit = plan.skin.threshold_counts / 2;
  const double offset = sensel.mean - tare;
  return sensel.readings > 0 && is_still(sensel, index) && std::abs(offset) > limit &&
         offset <= 2 * limit;
}

SenselWatch::SenselWatch(const SolverPlan& plan, std::chrono::milliseconds window) {
  check(plan, "SenselWatch");
  state_ = std::make_unique<State>(plan, window);
}

SenselWatch::~SenselWatch() = default;

void SenselWatch::offer(const FrameView& frame) {
  if (!state_->is_ready) return;
  const std::unique_lock lock(state_->mutex, std::try_to_lock);
  if (!lock || !state_->is_ready.exchange(false)) return;
  copy_readings(frame, state_->frame.bytes().data());
  state_->is_full = true;
  state_->changed.notify_one();
}

void SenselWatch::set_plan(const SolverPlan& plan) {
  const std::scoped_lock lock(state_->mutex);
  state_->new_plan = plan;
  state_->changed.notify_one();
}

SenselHealth SenselWatch::health() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->published;
}

}  // namespace pillarfield
