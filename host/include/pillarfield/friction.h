#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace pillarfield {

/// Prior of the friction coefficient of every contact, log-normal (docs/derivations/contact.md,
/// C1).
struct FrictionKnowledge {
  double median = 1;    ///< [0.1, 9.9]
  double spread = 0.5;  ///< standard deviation of the logarithm, [0.01, 3]
  /// The coefficient, [0.1, 9.9], if it is known to 3 %. Replaces median and spread.
  std::optional<double> given = std::nullopt;
  /// An upper bound, [0.1, 100]. Unset: none.
  std::optional<double> bound = std::nullopt;
  /// Carry the estimate of a contact over to the next frame. Turn it off if consecutive frames are
  /// unrelated.
  bool memory = true;
};

/// Throws Error, naming `where`, if a member is out of range.
void check(const FrictionKnowledge& friction, std::string_view where);

/// Source of the friction coefficient of a contact.
enum class FrictionSource : std::uint8_t {
  prior,         ///< FrictionKnowledge alone, without readings
  given,         ///< FrictionKnowledge::given
  observed,      ///< the pillars of this frame
  carried_over,  ///< the pillars of earlier frames
  at_least,      ///< the pillars, which stick or may stick: a lower bound
};

/// "prior", "given", "observed", "carried_over", "at_least".
[[nodiscard]] const char* name_of(FrictionSource source);

/// The estimated friction coefficient of a contact, log-normal.
struct ContactFriction {
  double median = 0;
  double spread = 0;  ///< standard deviation of the logarithm
  FrictionSource source = FrictionSource::prior;
  /// The friction is at least this in 19 of 20 cases: the report of FrictionSource::at_least.
  double least = 0;
};

}  // namespace pillarfield
