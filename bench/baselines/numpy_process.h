#pragma once

#include <filesystem>
#include <optional>

#include "base/child_program.h"
#include "bench/frames.h"
#include "pillarfield/force_field.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield::bench {

/// The bare direct solve in NumPy (solve.py) in a child process, which reads the number of frames
/// to solve from a pipe. The frames and its first result pass through files.
class NumpyProcess {
 public:
  /// Throws an Error that begins with kSkipped where no Python has NumPy.
  NumpyProcess(const SolverPlan& plan, const Frames& frames);
  ~NumpyProcess();
  NumpyProcess(const NumpyProcess&) = delete;
  NumpyProcess& operator=(const NumpyProcess&) = delete;

  /// Solves `frames` frames; returns the nanoseconds per pillar that the child measured.
  double run(int frames);

  /// Result of the first frame.
  [[nodiscard]] const ForceField& first_result() const { return first_; }

 private:
  bool starts(const char* python, const SolverPlan& plan);

  std::filesystem::path folder_;
  ForceField first_;
  std::optional<ChildProgram> child_;
};

}  // namespace pillarfield::bench
