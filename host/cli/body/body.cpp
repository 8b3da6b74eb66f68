// pillarfield body: plans and simulates the skin of a whole body.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/body/simulation.h"
#include "cli/body/timing.h"
#include "cli/commands.h"
#include "cli/json_text.h"
#include "cli/number_text.h"
#include "cli/progress.h"
#include "pillarfield/printable.h"

namespace pillarfield::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Sums over the patches of a body.
struct BodySize {
  explicit BodySize(const BodySkin& skin) {
    for (const BodyPatch& patch : skin.patches) {
      const Skin& size = patch.plan.skin;
      sensels += size.sensels();
      pillars += size.pillars();
      area_m2 += 1e-6 * static_cast<double>(size.pillars()) * size.pillar_pitch_mm() *
                 size.pillar_pitch_mm();
    }
  }
  std::size_t sensels = 0;
  std::size_t pillars = 0;
  double area_m2 = 0;
};

/// Gbit/s of so many bytes a frame.
double gigabits(std::size_t bytes, double rate_hz) {
  return 8e-9 * static_cast<double>(bytes) * rate_hz;
}

double quantile_of(std::vector<double> values, double fraction) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  const double rank = std::ceil(fraction * static_cast<double>(values.size())) - 1;
  return values[static_cast<std::size_t>(std::max(rank, 0.0))];
}

Json size_json(const BodyOptions& options, const BodySkin& skin) {
  const BodySize size(skin);
  return {{"body", options.file},       {"patches", skin.patches.size()}, {"area_m2", size.area_m2},
          {"sensels", size.sensels},    {"pillars", size.pillars},        {"rate_hz", skin.rate_hz},
          {"refresh_s", skin.refresh_s}};
}

void print_size(const BodyOptions& options, const BodySkin& skin) {
  const BodySize size(skin);
  fmt::print("{}: {} patches, {:.3f} m2, {} sensels, {} pillars, {:g} Hz\n",
             printable(options.file), skin.patches.size(), size.area_m2, grouped(size.sensels),
             grouped(size.pillars), skin.rate_hz);
}

void print_plan(const BodyOptions& options, const BodySkin& skin,
                const std::vector<BodyTiming>& timings) {
  print_size(options, skin);
  fmt::print("  {:<16} {:>11} {:>9} {:>9}\n", "patch", "sensels", "mm x mm", "Mbit/s");
  for (const BodyPatch& patch : skin.patches) {
    const Skin& size = patch.plan.skin;
    fmt::print("  {:<16} {:>11} {:>9} {:>9.0f}\n", printable(patch.name),
               fmt::format("{} x {}", size.rows, size.cols),
               fmt::format("{:.0f} x {:.0f}", size.cols * size.sensel_pitch_mm,
                           size.rows * size.sensel_pitch_mm),
               1e3 * gigabits(size.sensels() * size_of(patch.plan.sensel_type), skin.rate_hz));
  }
  fmt::print(
      "Changed blocks against whole frames, measured on this machine:\n"
      "  {:>8} {:>11} {:>11} {:>11} {:>11}\n",
      "changed", "blocks, ms", "whole, ms", "Gbit/s", "whole");
  for (const BodyTiming& timing : timings) {
    fmt::print("  {:>6.0f} % {:>11.3f} {:>11.3f} {:>11.2f} {:>11.2f}\n", 100 * timing.share,
               timing.changed_ms, timing.whole_ms, gigabits(timing.changed_bytes, skin.rate_hz),
               gigabits(timing.whole_bytes, skin.rate_hz));
  }
  fmt::print("Changed blocks take less time up to {:.0f} % of the blocks\n",
             100 * break_even(timings));
}

Json plan_json(const BodyOptions& options, const BodySkin& skin,
               const std::vector<BodyTiming>& timings) {
  Json json = size_json(options, skin);
  for (const BodyTiming& timing : timings) {
    json["timings"].push_back({{"changed_share", timing.share},
                               {"changed_ms", timing.changed_ms},
                               {"whole_ms", timing.whole_ms},
                               {"changed_bytes", timing.changed_bytes},
                               {"whole_bytes", timing.whole_bytes}});
  }
  json["break_even_share"] = break_even(timings);
  return json;
}

Json run_json(const BodyOptions& options, const BodySkin& skin, const BodyRun& run) {
  Json json = size_json(options, skin);
  json.update({{"loss_percent", options.loss_percent},
               {"frames", run.frame_ms.size()},
               {"frame_median_ms", quantile_of(run.frame_ms, 0.5)},
               {"frame_p99_ms", quantile_of(run.frame_ms, 0.99)},
               {"receive_median_ms", quantile_of(run.receive_ms, 0.5)},
               {"late", run.late},
               {"changed_share", run.changed_share},
               {"sent_share", run.sent_share},
               {"packets", run.packets},
               {"lost_packets", run.lost_packets},
               {"bytes", run.bytes},
               {"old_blocks", run.old_blocks},
               {"old_blocks_at_end", run.old_at_end},
               {"longest_healing_s", run.longest_healing_s},
               {"worst_clock_s", run.worst_clock_s}});
  return json;
}

Json vector_json(const Vector3& vector) { return {vector.x, vector.y, vector.z}; }

Json load_json(const BodyLoad& load) {
  Json json = {{"force_n", vector_json(load.wrench.force_n)},
               {"moment_nmm", vector_json(load.wrench.moment_nmm)},
               {"normal_n", load.normal_n}};
  json["centre_of_pressure_mm"] =
      load.centre_of_pressure_mm ? vector_json(*load.centre_of_pressure_mm) : Json();
  return json;
}

void print_run(const BodyOptions& options, const BodySkin& skin, const BodyRun& run) {
  print_size(options, skin);
  fmt::print("  frames    {:9}  changed {:.1f} % of the blocks, sent {:.1f} %, {:.2f} Gbit/s\n",
             run.frame_ms.size(), 100 * run.changed_share, 100 * run.sent_share,
             gigabits(run.bytes, skin.rate_hz) / static_cast<double>(run.frame_ms.size() + 1));
  fmt::print("  a frame   {:9.3f} ms median, {:.3f} ms p99; {:.3f} ms of it to receive\n",
             quantile_of(run.frame_ms, 0.5), quantile_of(run.frame_ms, 0.99),
             quantile_of(run.receive_ms, 0.5));
  fmt::print("  late      {:9}  solved after the next one was due\n", run.late);
  fmt::print("  lost      {:9}  of {} packets; {} blocks had old readings, for {:.3f} s at most\n",
             run.lost_packets, grouped(run.packets), grouped(run.old_blocks),
             run.longest_healing_s);
  fmt::print("  clocks    {:9.3f} ms largest error of a patch's host time\n",
             1e3 * run.worst_clock_s);
}

void print_loads(const WholeBody& body) {
  fmt::print("Load in the body's frame at the end\n  {:<16} {:>28} {:>10} {:>28}\n", "patch",
             "force, N", "normal, N", "centre of pressure, mm");
  const auto line = [](const std::string& name, const BodyLoad& load) {
    const auto text = [](const Vector3& v) {
      return fmt::format("{:.1f}, {:.1f}, {:.1f}", v.x, v.y, v.z);
    };
    fmt::print("  {:<16} {:>28} {:>10.1f} {:>28}\n", printable(name), text(load.wrench.force_n),
               load.normal_n, load.centre_of_pressure_mm ? text(*load.centre_of_pressure_mm) : "-");
  };
  for (std::size_t i = 0; i < body.skin().patches.size(); ++i) {
    line(body.skin().patches[i].name, body.patch(i).load);
  }
  line("all", body.load());
}

}  // namespace

void plan_body(const BodyOptions& options) {
  const BodySkin skin = load_body(options.file).skin;
  const std::vector<BodyTiming> timings = time_body(
      open_device(options.device.name), skin, {0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1}, options.quiet);
  if (options.json) {
    fmt::print("{}\n", json_text(plan_json(options, skin, timings)));
  } else {
    print_plan(options, skin, timings);
  }
}

void simulate_body(const BodyOptions& options) {
  BodyFile file = load_body(options.file);
  if (options.rate_hz) file.skin.rate_hz = *options.rate_hz;
  if (options.refresh_s) file.skin.refresh_s = *options.refresh_s;
  BodySimulation simulation(file, options.scene_frames, options.quiet);
  WholeBody body(open_device(options.device.name), file.skin);
  const auto frames =
      static_cast<std::uint64_t>(std::max(2.0, std::round(options.seconds * file.skin.rate_hz)));
  const BodyRun run =
      simulation.run(body, frames, 0.01 * options.loss_percent, options.seed, options.quiet);
  if (options.json) {
    Json json = run_json(options, file.skin, run);
    json["load"] = load_json(body.load());
    fmt::print("{}\n", json_text(json));
    return;
  }
  print_run(options, file.skin, run);
  print_loads(body);
}

}  // namespace pillarfield::cli
