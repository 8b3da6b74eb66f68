// What each stage costs, and what the number of lanes does.

#include <fmt/format.h>

#include <string>

#include "report/speed/section.h"
#include "report/table.h"

namespace pillarfield::report {
namespace {

constexpr const char* kStages = R"(## Stage by stage

The bare solve of a square metre, and with one stage more. A stage that nobody asks for is not compiled, so each has its own kernel, its own
bytes and its own ceiling. `all` is what a calibrated sensor needs: tare, gain, mask, dead zone, saturation, uncertainty and angles.

)";

constexpr const char* kLanes = R"(
## Lanes

How many pillars a work-item solves at once. PoCL makes of each work-item's vectors the vector instructions of the processor; a GPU does that by itself,
and takes one pillar per work-item.

)";

std::string stage_of(const std::string& row) { return row.substr(row.find('/') + 1); }

std::string stages_table(const BenchRun& bench) {
  Table table("lrrrrr", {"Stage", "bytes per pillar", "ns per pillar", "copy",
                         "share of the ceiling", "time over bare"});
  const double bare = bench.value("stage/none", "ns_per_pillar");
  for (const std::string& row : bench.rows_of("stage")) {
    const double time = bench.value(row, "ns_per_pillar");
    const double share = bench.value(row, "of_ceiling");
    table.add({stage_of(row), fmt::format("{:.0f}", bench.value(row, "bytes_per_pillar")),
               fmt::format("{:.3g}", time), fmt::format("{:.3g}", share * time),
               fmt::format("{:.2f}", share), fmt::format("{:.2f}", time / bare)});
  }
  return table.text();
}

bool ran_on_gpu(const BenchRun& bench) {
  return bench.context("device").find("(GPU)") != std::string::npos;
}

std::string lanes_table(const BenchRun& bench) {
  Table table("lrr", {"Lanes", "ns per pillar", "share of the ceiling"});
  for (const std::string& row : bench.rows_of("lanes")) {
    table.add({stage_of(row), fmt::format("{:.3g}", bench.value(row, "ns_per_pillar")),
               fmt::format("{:.3f}", bench.value(row, "of_ceiling"))});
  }
  // On a GPU the rows above are its own.
  if (!ran_on_gpu(bench)) {
    table.add({"GPU, 1 lane: unmeasured, there was none", "–", "–"});
  }
  return table.text();
}

}  // namespace

std::string stages_section(const SpeedContext& context) {
  const BenchRun& bench = context.run.bench;
  return kStages + stages_table(bench) + kLanes + lanes_table(bench);
}

}  // namespace pillarfield::report
