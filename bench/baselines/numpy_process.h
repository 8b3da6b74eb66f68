#pragma once

#include <filesystem>
#include <optional>

#include "base/child_program.h"
#include "bench/frames.h"
#include "pillarfield/force_field.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield::bench {

/// The bare direct solve in NumPy (solve.py), by a child that waits to be told how many frames to
/// solve. The frames and its first result pass through files.
class NumpyProcess {
 public:
  /// Throws Error that begins with kSkipped where there is no Python with NumPy.
  NumpyProcess(const SolverPlan& plan, const Frames& frames);
  ~NumpyProcess();
  NumpyProcess(const NumpyProcess&) = delete;
  NumpyProcess& operator=(const NumpyProcess&) = delete;

  /// Solves so many frames; returns the nanoseconds per pillar that the child measured.
  double run(int frames);

  /// Its result of the first frame.
  [[nodiscard]] const ForceField& first_result() const { return first_; }

 private:
  bool starts(const char* python, const SolverPlan& plan);

  std::filesystem::path folder_;
  ForceField first_;
  std::optional<ChildProgram> child_;
};

}  // namespace pillarfield::bench
