#include "cli/stream/run_cost.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include "pillarfield/frame.h"

namespace pillarfield::cli {
namespace {

/// Processor time of all threads of this process, user and system.
double core_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::size_t bytes_of(const ForceFieldView& forces) {
  std::size_t bytes = forces.status.size_bytes();
  for (const auto& plane : {forces.shear_x, forces.shear_y, forces.normal, forces.magnitude,
                            forces.theta, forces.phi}) {
    bytes += plane.size_bytes();
  }
  for (const auto& plane : forces.uncertainty) bytes += plane.size_bytes();
  return bytes;
}

}  // namespace

RunCost::RunCost(const SolverPlan& plan)
    : readings_bytes_(plan.skin.sensels() * size_of(plan.sensel_type)),
      core_s_at_start_(core_seconds()) {}

void RunCost::count(const ForceFieldView& forces) {
  forces_bytes_ = bytes_of(forces);
  ++frames_;
}

void RunCost::look() {
  seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  core_s_ = core_seconds() - core_s_at_start_;
}

double RunCost::per_frame(double total) const { return total / static_cast<double>(frames_); }

double RunCost::gb_per_s(std::size_t frame_bytes) const {
  return 1e-9 * static_cast<double>(frame_bytes) / per_frame(seconds_);
}

nlohmann::ordered_json RunCost::json() const {
  if (frames_ == 0) return nullptr;
  return {{"readings_gb_per_s", gb_per_s(readings_bytes_)},
          {"forces_gb_per_s", gb_per_s(forces_bytes_)},
          {"core_s_per_frame", per_frame(core_s_)}};
}

std::string RunCost::text() const {
  if (frames_ == 0) return "";
  return fmt::format(
      "  traffic    {:.3g} GB/s of readings in, {:.3g} GB/s of forces out\n"
      "  a frame    {:.3g} core-milliseconds\n",
      gb_per_s(readings_bytes_), gb_per_s(forces_bytes_), 1e3 * per_frame(core_s_));
}

}  // namespace pillarfield::cli
