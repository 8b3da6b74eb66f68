#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "pillarfield/force_sink.h"
#include "pillarfield/recording.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// Share of the elements that exist from which on contact covers the array.
inline constexpr double kCovered = 0.8;

/// Elements with a usable sensel.
[[nodiscard]] std::uint64_t count_in_contact(std::span<const std::uint8_t> status);

/// The sentence for a user where contact covers this share of the array.
[[nodiscard]] std::string coverage_words(double share, bool has_tare, SkinLayout layout);

/// Raises the noise and the relative error that a plan states to what its frames show by the parity
/// of pillars, where that is clearly more, and returns a sentence about each error
/// (docs/derivations/uncertainty.md, section 5). Reads 64 to 256 of the frames, spread over all, or
/// with a followed baseline the first 4096.
[[nodiscard]] std::vector<std::string> allow_for_errors(SolverPlan& plan, FrameSource& source);

class LineCheck;
class ParityCheck;

/// Notices solved frames whose readings were probably not what the plan takes them for: no tare,
/// readings that fall under load, a threshold above all readings, frames without readings, more
/// noise than is stated, readings that contradict each other.
class ReadingCheck final : public ForceSink {
 public:
  /// `plan` must outlive the check. `judges_errors`: by parity, of frames that come once, which
  /// allow_for_errors() cannot read first.
  explicit ReadingCheck(const SolverPlan& plan, bool judges_errors = false);

  /// Counts a frame. Looks at its readings only where hardly any pillar is in contact.
  void append(const SolvedFrame& frame) override;

  /// Warnings about the readings, one sentence each. Simulated frames need none.
  [[nodiscard]] std::vector<std::string> warnings() const;

 private:
  struct Counts {
    std::uint64_t good = 0;   ///< sensels that are not masked
    std::uint64_t above = 0;  ///< sensels beyond the threshold over their tare
    std::uint64_t below = 0;  ///< and under it
    float highest = 0;        ///< reading over its tare, counts
    float lowest = 0;
  };
  template <class Reading>
  [[nodiscard]] Counts count(const FrameView& readings) const;
  void look_at(const FrameView& readings);
  void warn_of_no_contact(std::vector<std::string>& sentences) const;

  const SolverPlan& plan_;
  std::uint64_t present_ = 0;  ///< pillars of a frame that have sensels
  std::uint64_t frames_ = 0;
  std::uint64_t in_contact_ = 0;     ///< pillars of all frames
  std::uint64_t blank_frames_ = 0;   ///< frames without a reading
  std::uint64_t sunken_frames_ = 0;  ///< nearly all sensels read less than their tare
  std::uint64_t sensels_seen_ = 0;
  Counts most_;
  std::shared_ptr<ParityCheck> parity_;
  std::shared_ptr<LineCheck> lines_;
};

}  // namespace pillarfield
