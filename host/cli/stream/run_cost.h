#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "pillarfield/force_field.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield::cli {

/// The cost of a run: its traffic and core-seconds from construction on.
class RunCost {
 public:
  explicit RunCost(const SolverPlan& plan);

  void count(const ForceFieldView& forces);

  /// Reads the times.
  void look();

  /// As of the last look; null and "" without a frame.
  [[nodiscard]] nlohmann::ordered_json json() const;
  [[nodiscard]] std::string text() const;

 private:
  [[nodiscard]] double gb_per_s(std::size_t frame_bytes) const;
  [[nodiscard]] double per_frame(double total) const;

  std::size_t readings_bytes_;    ///< of a frame
  std::size_t forces_bytes_ = 0;  ///< of a frame
  std::uint64_t frames_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double core_s_at_start_;
  double seconds_ = 0;
  double core_s_ = 0;
};

}  // namespace pillarfield::cli
