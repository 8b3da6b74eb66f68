#pragma once

#include "bench/timing/solve_timing.h"

namespace pillarfield::bench {

// Each function registers the cases of some groups, which docs/benchmark.md describes. The session
// must outlive them.

void add_limit_cases(const Session& session);     ///< limit/
void add_size_cases(const Session& session);      ///< size/, contact/, regions/
void add_plan_cases(const Session& session);      ///< type/, lanes/, stage/, sensor/
void add_time_cases(const Session& session);      ///< latency/, throughput/
void add_baseline_cases(const Session& session);  ///< baseline/
void add_field_cases(const Session& session);     ///< field/

}  // namespace pillarfield::bench
