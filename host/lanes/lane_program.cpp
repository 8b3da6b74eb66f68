#include <algorithm>
#include <vector>

#include "lanes/lane_plan.h"

namespace pillarfield {

// The build gives them the names of their targets.
// NOLINTBEGIN(readability-identifier-naming)
#if defined(__x86_64__)
extern const LaneProgram lanes_avx512;
extern const LaneProgram lanes_avx2;
#endif
extern const LaneProgram lanes_baseline;
extern const LaneProgram lanes_narrow;
// NOLINTEND(readability-identifier-naming)

std::span<const LaneProgram* const> lane_programs() {
  static const std::vector<const LaneProgram*> programs = [] {
    std::vector<const LaneProgram*> runnable;
#if defined(__x86_64__)
    // AVX-512 as processors have it since Skylake: all four parts.
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) {
      runnable.push_back(&lanes_avx512);
    }
    if (__builtin_cpu_supports("avx2")) runnable.push_back(&lanes_avx2);
#endif
    runnable.push_back(&lanes_baseline);
    runnable.push_back(&lanes_narrow);
    return runnable;
  }();
  return programs;
}

const LaneProgram& lane_program(std::uint32_t quad_cols, int most) {
  const auto programs = lane_programs();
  const auto found = std::ranges::find_if(programs, [&](const LaneProgram* program) {
    return program->lanes <= most && static_cast<std::uint32_t>(program->lanes) <= quad_cols;
  });
  return found == programs.end() ? *programs.back() : **found;
}

}  // namespace pillarfield
