// Others who solve the same frames.

#include <fmt/format.h>

#include <string>

#include "bench/timing/plain_names.h"
#include "report/speed/section.h"
#include "report/table.h"

namespace pillarfield::report {
namespace {

struct Opponent {
  const char* row;
  const char* what;
};

constexpr Opponent kOpponents[] = {
    {"opponent/vectorised", "the same solve by hand for this processor"},
    {"opponent/cpp_all_threads", "C++ loop over the same mathematics, all threads"},
    {"opponent/cpp_one_thread", "C++ loop, one thread"},
    {"opponent/numpy", "NumPy, array expressions"},
    {"opponent/paper_opencl", "the paper's equations in OpenCL"},
};

constexpr const char* kIntroduction = R"(## Opponents

Each solves the frames of the bare square metre in a race with ours, and is held to our result before its time is taken
([benchmark.md](benchmark.md) says how each is made). *Times ours* is its time over ours: below 1 the opponent is faster.

)";

std::string without_mark(const std::string& why) {
  const std::string mark = bench::kSkipped;
  return why.starts_with(mark) ? why.substr(mark.size()) : why;
}

}  // namespace

std::string opponents_section(const SpeedContext& context) {
  const BenchRun& bench = context.run.bench;
  Table table("llrrrr",
              {"Opponent", "how", "ns per pillar", "ours", "times ours", "share of the ceiling"});
  for (const auto& [row, what] : kOpponents) {
    if (const std::string& why = bench.why_left_out(row); !why.empty()) {
      table.add({what, fmt::format("unmeasured: {}", without_mark(why)), "–", "–", "–", "–"});
      continue;
    }
    table.add({what, bench.label(row), fmt::format("{:.3g}", bench.value(row, "ns_per_pillar")),
               fmt::format("{:.3g}", bench.value(row, "our_ns_per_pillar")),
               fmt::format("{:.3g}", bench.value(row, "speedup")),
               fmt::format("{:.3f}", bench.value(row, "of_ceiling"))});
  }
  return kIntroduction + table.text();
}

}  // namespace pillarfield::report
