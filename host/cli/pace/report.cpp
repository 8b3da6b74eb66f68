#include "cli/pace/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "cli/json_text.h"
#include "base/number_text.h"
#include "pillarfield/printable.h"
#include "pillarfield/tuning.h"

namespace pillarfield::cli {
namespace {

using Json = nlohmann::ordered_json;

double seconds(Nanoseconds time) { return std::chrono::duration<double>(time).count(); }
double microseconds(Nanoseconds time) { return static_cast<double>(time.count()) / 1e3; }
double milliseconds(Nanoseconds time) { return static_cast<double>(time.count()) / 1e6; }

double achieved_rate_hz(const PaceResult& result) {
  return result.elapsed > Nanoseconds(0)
             ? static_cast<double>(result.solved()) / seconds(result.elapsed)
             : 0;
}

double busy_cores(const PaceReport& report) {
  const Nanoseconds elapsed = report.result.elapsed;
  return elapsed > Nanoseconds(0) ? report.usage.cpu_s / seconds(elapsed) : 0;
}

double contact_share(const RegionCount& pillars) {
  return pillars.all() == 0
             ? 0
             : static_cast<double>(pillars.in_contact()) / static_cast<double>(pillars.all());
}

Json json_of(const std::optional<Nanoseconds>& latency) {
  return latency ? Json(milliseconds(*latency)) : Json(nullptr);
}

Json histogram_json(const Latencies& latencies) {
  Json bins = Json::array();
  for (const LatencyBin& bin : latencies.histogram()) {
    bins.push_back({{"from_ms", milliseconds(bin.from)},
                    {"to_ms", milliseconds(bin.to)},
                    {"frames", bin.frames}});
  }
  return bins;
}

Json realtime_json(const std::optional<RealtimeRefusals>& realtime) {
  if (!realtime) return nullptr;
  return {{"scheduling", realtime->scheduling.empty()},
          {"locked_memory", realtime->memory.empty()}};
}

std::string text_of(const std::optional<Nanoseconds>& latency) {
  return latency ? fmt::format("{:.3f}", milliseconds(*latency)) : "never";
}

void print_counts(const PaceReport& report, const Latencies& latencies) {
  const PaceResult& result = report.result;
  const PaceSchedule& schedule = report.schedule;
  fmt::print("  scheduled {:9}  in {:.3f} s\n", result.scheduled(), seconds(result.elapsed));
  fmt::print("  solved    {:9}  {} of {} frames/s requested\n", result.solved(),
             rounded(achieved_rate_hz(result)), rounded(schedule.rate_hz));
  fmt::print("  dropped   {:9}  more than {} periods late\n", result.dropped,
             schedule.backlog_frames);
  fmt::print("  missed    {:9}  solved later than the deadline of {:.3f} ms\n",
             latencies.later_than(report.deadline), milliseconds(report.deadline));
}

void print_histogram(const std::vector<LatencyBin>& bins) {
  constexpr double kBarWidth = 40;
  const auto fuller = [](const LatencyBin& a, const LatencyBin& b) { return a.frames < b.frames; };
  const auto fullest = std::ranges::max_element(bins, fuller);
  for (const LatencyBin& bin : bins) {
    const double share = static_cast<double>(bin.frames) / static_cast<double>(fullest->frames);
    fmt::print("  {:>8.3f} to {:>8.3f} {:>9}  {}\n", milliseconds(bin.from), milliseconds(bin.to),
               bin.frames,
               std::string(static_cast<std::size_t>(std::ceil(kBarWidth * share)), '#'));
  }
}

void print_latencies(const Latencies& latencies) {
  fmt::print("Latency from the due time, ms{}\n",
             latencies.quantile(1) ? "" : " (infinite for dropped frames)");
  fmt::print("  p50 {}  p99 {}  p99.9 {}  longest {}\n", text_of(latencies.quantile(0.5)),
             text_of(latencies.quantile(0.99)), text_of(latencies.quantile(0.999)),
             text_of(latencies.largest()));
  print_histogram(latencies.histogram());
}

void print_usage(const PaceReport& report) {
  const ProcessUsage& usage = report.usage;
  fmt::print(
      "Used {:.2f} of {} cores; {} voluntary and {} involuntary context switches; page faults: ",
      busy_cores(report), std::thread::hardware_concurrency(), grouped(usage.voluntary_switches),
      grouped(usage.involuntary_switches));
  fmt::print("{} from memory, {} from disk\n", grouped(usage.minor_page_faults),
             grouped(usage.major_page_faults));
}

}  // namespace

std::uint64_t failures(const PaceReport& report) {
  return report.result.dropped + Latencies(report.result).later_than(report.deadline);
}

void print_pace_json(const PaceReport& report, const SolverPlan& plan, const Processor& processor) {
  const PaceResult& result = report.result;
  const ProcessUsage& usage = report.usage;
  const Latencies latencies(result);
  const Json json = {{"source", report.source},
                     {"device", processor.device().info().name},
                     {"zero_copy", processor.shares_memory()},
                     {"estimator", name_of(plan.estimator)},
                     {"stages", kernel_stages(plan)},
                     {"pillar_rows", plan.skin.pillar_rows()},
                     {"pillar_cols", plan.skin.pillar_cols()},
                     {"frames_in_source", report.frames_in_source},
                     {"frames_loaded", report.frames_loaded},
                     {"rate_hz", report.schedule.rate_hz},
                     {"deadline_ms", milliseconds(report.deadline)},
                     {"backlog_frames", report.schedule.backlog_frames},
                     {"frames_in_flight", report.frames_in_flight},
                     {"spin_us", microseconds(report.schedule.spin)},
                     {"realtime", realtime_json(report.realtime)},
                     {"interrupted", result.interrupted},
                     {"scheduled", result.scheduled()},
                     {"solved", result.solved()},
                     {"dropped", result.dropped},
                     {"missed", latencies.later_than(report.deadline)},
                     {"seconds", seconds(result.elapsed)},
                     {"achieved_rate_hz", achieved_rate_hz(result)},
                     {"latency_p50_ms", json_of(latencies.quantile(0.5))},
                     {"latency_p99_ms", json_of(latencies.quantile(0.99))},
                     {"latency_p99_9_ms", json_of(latencies.quantile(0.999))},
                     {"latency_longest_ms", json_of(latencies.largest())},
                     {"latency_histogram", histogram_json(latencies)},
                     {"cpu_cores", busy_cores(report)},
                     {"voluntary_switches", usage.voluntary_switches},
                     {"involuntary_switches", usage.involuntary_switches},
                     {"minor_page_faults", usage.minor_page_faults},
                     {"major_page_faults", usage.major_page_faults},
                     {"contact_share", contact_share(report.last_frame)}};
  fmt::print("{}\n", json_text(json));
}

void print_pace_text(const PaceReport& report, const SolverPlan& plan, const Processor& processor) {
  const DeviceInfo& device = processor.device().info();
  if (report.result.interrupted) fmt::print("Interrupted; results so far\n");
  fmt::print("{}: {} x {} pillars on {} ({}, {})\n", printable(report.source),
             plan.skin.pillar_rows(), plan.skin.pillar_cols(), device.name, device.type,
             processor.shares_memory() ? "zero copy" : "staged");
  fmt::print("Stages: {}\n", fmt::join(kernel_stages(plan), ", "));
  const Latencies latencies(report.result);
  print_counts(report, latencies);
  print_latencies(latencies);
  print_usage(report);
  fmt::print("In contact in the last frame: {} of the pillars\n",
             percent(report.last_frame.in_contact(), report.last_frame.all()));
}

}  // namespace pillarfield::cli
