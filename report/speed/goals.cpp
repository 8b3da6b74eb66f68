#include "report/speed/goals.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "report/table.h"

namespace pillarfield::report {
namespace {

using Measured = std::optional<double>;

/// One over the other, where both are there.
Measured ratio(Measured numerator, Measured denominator) {
  if (!numerator || !denominator) return std::nullopt;
  return *numerator / *denominator;
}

Measured of_ceiling(const SpeedRun& run, const char* row) {
  return run.bench.find(row, "of_ceiling");
}

Measured speedup(const SpeedRun& run, const char* row) { return run.bench.find(row, "speedup"); }

/// Both rows have the same bytes: measured by their copies they compare as if in one race.
Measured sparse_over_dense(const SpeedRun& run) {
  return ratio(of_ceiling(run, "contact/100/bare"), of_ceiling(run, "contact/1/bare"));
}

/// The slowest of the large skins over the fastest.
Measured unevenness(const SpeedRun& run) {
  double least = 0;
  double most = 0;
  for (const char* const row : {"size/99856", "size/624100", "size/1000000", "size/9998244"}) {
    const Measured time = run.bench.find(row, "ns_per_pillar");
    if (!time) return std::nullopt;
    least = least == 0 ? *time : std::min(least, *time);
    most = std::max(most, *time);
  }
  return most / least;
}

Measured late_frames(const SpeedRun& run) {
  if (!run.live) return std::nullopt;
  return static_cast<double>(run.live->missed + run.live->dropped);
}

struct Rule {
  const char* what;
  bool at_least;
  double limit;
  Measured (*measure)(const SpeedRun& run);
};

constexpr bool kAtLeast = true;
constexpr bool kAtMost = false;

constexpr std::array kRules = {
    Rule{"Bare solve of 10⁶ pillars from memory: share of the copy's speed", kAtLeast, 0.95,
         [](const SpeedRun& run) { return of_ceiling(run, "size/1000000"); }},
    Rule{"Bare solve of 10⁵ pillars in the cache: share of the copy's speed", kAtLeast, 0.85,
         [](const SpeedRun& run) { return of_ceiling(run, "size/99856"); }},
    Rule{"Times as fast as the loop vectorised by hand", kAtLeast, 1,
         [](const SpeedRun& run) { return speedup(run, "opponent/vectorised"); }},
    Rule{"Times as fast as the paper's equations in OpenCL, one pillar per work-item", kAtLeast, 80,
         [](const SpeedRun& run) { return speedup(run, "opponent/paper_opencl"); }},
    Rule{"Times as fast as NumPy", kAtLeast, 50,
         [](const SpeedRun& run) { return speedup(run, "opponent/numpy"); }},
    Rule{"All stages: time over the copy of the same bytes", kAtMost, 1.3,
         [](const SpeedRun& run) { return ratio(1, of_ceiling(run, "stage/all")); }},
    Rule{"1 % in contact: time over that of the whole skin in contact", kAtMost, 0.3,
         sparse_over_dense},
    Rule{"10⁵ to 10⁷ pillars: most over least time per pillar", kAtMost, 1.25, unevenness},
    Rule{"One frame of 79 × 79 pillars: time over that of an empty launch", kAtMost, 1.5,
         [](const SpeedRun& run) { return run.bench.find("latency/6241", "of_empty_launch"); }},
    Rule{"A square metre at 1 kHz, live: frames missed or dropped", kAtMost, 0, late_frames},
};

/// Three digits, and all of whole numbers.
std::string number(double value) {
  return value >= 100 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

}  // namespace

bool Goal::is_met() const {
  return measured && (at_least ? *measured >= limit : *measured <= limit);
}

std::vector<Goal> goals(const SpeedRun& run) {
  std::vector<Goal> all;
  all.reserve(kRules.size());
  for (const Rule& rule : kRules) {
    all.push_back({rule.what, rule.at_least, rule.limit, rule.measure(run)});
  }
  return all;
}

std::string goals_table(const std::vector<Goal>& goals) {
  Table table("lrrl", {"Goal", "wanted", "measured", ""});
  for (const Goal& goal : goals) {
    const char* const verdict = goal.is_met() ? "met" : "**not met**";
    table.add({goal.what, fmt::format("{} {:g}", goal.at_least ? "≥" : "≤", goal.limit),
               goal.measured ? number(*goal.measured) : "–",
               goal.measured ? verdict : "not measured"});
  }
  return table.text();
}

}  // namespace pillarfield::report
