#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// Errors of readings that parity shows, V1 + V3 = V2 + V4 whatever the load
/// (docs/derivations/uncertainty.md, section 5). Judges plans of pillars that state a noise.
class ParityCheck {
 public:
  /// `plan` must outlive the check.
  explicit ParityCheck(const SolverPlan& plan);

  /// Judges some of a frame's pillars; `follows`: the frame before was the last.
  void add(const FrameView& readings, bool follows = true);

  /// Errors that are clearly larger than stated; zero: none.
  struct Found {
    double noise = 0;       ///< standard deviation of a reading, counts, with rounding
    bool is_drift = false;  ///< seen under load alone, not from frame to frame
    double gain_error = 0;  ///< standard deviation of the gains, relative
  };
  [[nodiscard]] Found found() const;

  /// Standard deviation of a reading that the plan states, counts, with rounding; zero: none.
  [[nodiscard]] double stated_noise() const { return noise_; }
  [[nodiscard]] double without_rounding(double noise) const;

  /// One sentence for each error found, which deviations allow for or not.
  [[nodiscard]] std::vector<std::string> warnings(bool allowed_for) const;

 private:
  /// A pillar whose sensels are all usable.
  struct Load {
    double parity = 0;       ///< V1 + V3 - V2 - V4, counts; of a mean its square
    double square = 0;       ///< sum of V^2, counts^2
    double lowest = 0;       ///< V, counts
    std::size_t pillar = 0;  ///< of a mean the number of pillars
  };
  void count_change(const std::array<float, 4>& now, const std::array<float, 4>& before);
  void add_load(const std::array<float, 4>& load, std::size_t pillar);
  [[nodiscard]] double noise_of_changes() const;
  [[nodiscard]] Load mean_of(double noise, double least, double most) const;

  const SolverPlan& plan_;
  double noise_;
  double parity_unit_;  ///< of `changes_`, counts
  bool judges_loads_;
  std::vector<std::array<float, 4>> earlier_;  ///< readings of sampled pillars, the frame before
  std::vector<std::array<float, 4>> tares_;    ///< theirs, which may follow a drift
  std::array<std::uint64_t, 256> changes_{};   ///< numbers of changes of parity, by size
  std::vector<Load> loads_;
  std::size_t loads_seen_ = 0;
  std::size_t load_step_ = 1;  ///< one of so many is kept
};

}  // namespace pillarfield
