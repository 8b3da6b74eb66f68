#pragma once

#include <filesystem>
#include <string>

#include "pillarfield/processor.h"
#include "report/speed/run.h"

/// docs/performance.md, made from what pillarfield-bench measured. A section tells of one thing,
/// draws its pictures, and returns its text: Markdown that begins with a heading of level 2. Each
/// throws Error where the run lacks a row that it tells of.
namespace pillarfield::report {

struct SpeedContext {
  std::filesystem::path docs;  ///< pictures go to docs / "pictures/performance"
  SpeedRun run;
  Device device;  ///< on which errors are measured
};

[[nodiscard]] std::string machine_section(const SpeedContext& context);
[[nodiscard]] std::string goals_section(const SpeedContext& context);
[[nodiscard]] std::string variants_section(const SpeedContext& context);
[[nodiscard]] std::string sizes_section(const SpeedContext& context);
[[nodiscard]] std::string latency_section(const SpeedContext& context);
[[nodiscard]] std::string opponents_section(const SpeedContext& context);
[[nodiscard]] std::string stages_section(const SpeedContext& context);

}  // namespace pillarfield::report
