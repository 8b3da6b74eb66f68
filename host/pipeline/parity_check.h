#pragma once

#include <array>
#include <cstddef>
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

  struct Error {
    std::string fault;  ///< a clause
    std::string mend;   ///< a sentence
  };
  /// Errors that are clearly larger than stated; zero: none.
  struct Found {
    double noise = 0;     ///< standard deviation of a reading, counts, with rounding
    double relative = 0;  ///< ResidualError::relative
    std::vector<Error> errors;

    /// One for each error, which deviations allow for or not.
    [[nodiscard]] std::vector<std::string> sentences(bool allowed_for) const;
  };
  [[nodiscard]] Found found() const;

  /// Standard deviation of a reading that the plan states, counts, with rounding; zero: none.
  [[nodiscard]] double stated_noise() const { return noise_; }
  [[nodiscard]] double without_rounding(double noise) const;

  /// Sums with which the parity of a pillar is compared, for each cause that makes one.
  enum Term : std::size_t { kParity, kTare, kDrift, kSum, kX, kY, kCurve, kLeak, kTerms };
  using Products = std::array<std::array<double, kTerms>, kTerms>;

  /// Sums over the frames of a pillar.
  struct Pillar {
    std::array<float, 4> tare{};     ///< which may follow a drift
    std::array<float, 4> earlier{};  ///< readings of the frame before
    Products products{};             ///< of terms while all sensels are usable
    double change_squares = 0;       ///< of the parity's change from frame to frame
    double changes = 0;
  };

 private:
  void compare(const std::array<float, 4>& now, Pillar& pillar) const;
  [[nodiscard]] float load_of(const FrameView& readings, std::size_t row, std::size_t col) const;
  void add_load(const FrameView& readings, std::size_t row, std::size_t col,
                const std::array<float, 4>& load, Pillar& pillar);

  const SolverPlan& plan_;
  double noise_;
  bool judges_loads_;
  float usable_ = 0;  ///< least V that is judged, counts
  float most_ = 0;    ///< reading from which on none is, counts
  std::vector<Pillar> pillars_;
  double frames_ = 0;
};

}  // namespace pillarfield
