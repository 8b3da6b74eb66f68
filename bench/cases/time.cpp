// Latency of a frame, and frames per second.

#include <fmt/format.h>

#include <string>

#include "bench/cases/cases.h"
#include "bench/timing/solve_timing.h"

namespace pillarfield::bench {
namespace {

/// From a pad of 36 pillars to a square metre.
constexpr std::uint32_t kLatencySides[] = {6, 16, 32, 79, 128, 256, kSquareMetre};

/// From submit to result, one frame at a time: the host and the OpenCL device, interleaved with
/// empty launches.
Measurement time_latency(const Session& session, const SolverPlan& plan) {
  const Frames frames(plan.skin, plan.sensel_type, {});
  FrameSolver host(open_device("host"), plan, frames, {.frames_in_flight = 1});
  FrameSolver opencl(session.device, plan, frames, {.frames_in_flight = 1});
  EmptyLaunch launch(session.device);
  InterleavedTiming timing;
  const std::size_t on_host = timing.add([&](int count) { host.run(count); });
  const std::size_t on_opencl = timing.add([&](int count) { opencl.run(count); });
  const std::size_t empty = timing.add([&](int count) { launch.run(count); });
  // Turns have one frame each: quantiles are of single frames.
  timing.run({session.length.seconds, 20 * session.length.rounds, 0, 1});
  const bool is_hosts = session.solver.for_plan(plan).info().type == "host";
  const std::size_t solve = is_hosts ? on_host : on_opencl;
  Measurement measured = measurement_of(timing, solve, plan);
  const auto report = [&](const std::string& prefix, std::size_t entry) {
    measured.counters[prefix + "median_us"] = timing.median(entry) * 1e6;
    measured.counters[prefix + "p99_us"] = timing.quantile(entry, 0.99) * 1e6;
  };
  report("", solve);
  report("host_", on_host);
  report("opencl_", on_opencl);
  measured.counters["of_empty_launch"] = timing.ratio(solve, empty);
  measured.label =
      fmt::format("{} times, {}", timing.times(solve).size(), (is_hosts ? host : opencl).device());
  return measured;
}

void add_throughput_case(const Session& session, const char* name, Memory memory, int in_flight) {
  add_case(fmt::format("throughput/{}/{}", name, in_flight), [&session, memory, in_flight] {
    Measurement measured = time_solve(session, bare_plan(kSquareMetre), {},
                                      {.memory = memory, .frames_in_flight = in_flight});
    measured.counters["frames_per_s"] = 1 / measured.seconds;
    return measured;
  });
}

}  // namespace

void add_time_cases(const Session& session) {
  for (const std::uint32_t side : kLatencySides) {
    const SolverPlan plan = bare_plan(side);
    add_case(fmt::format("latency/{}", plan.skin.pillars()),
             [&session, plan] { return time_latency(session, plan); });
  }
  for (const int in_flight : {1, 2, 3}) {
    add_throughput_case(session, "shared", Memory::shared, in_flight);
    add_throughput_case(session, "staged", Memory::staged, in_flight);
  }
}

}  // namespace pillarfield::bench
