#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace pillarfield {

/// What is known of friction coefficients before any reading: a log-normal distribution, the same
/// for all contacts (docs/derivations/contact.md, C1).
struct FrictionKnowledge {
  double median = 1;    ///< [0.1, 9.9]
  double spread = 0.5;  ///< standard deviation of the logarithm, [0.01, 3]
  /// The friction itself, [0.1, 9.9], to 3 %; it takes the place of median and spread. Unset: not
  /// known.
  std::optional<double> given = std::nullopt;
  /// No friction is larger, [0.1, 100]; unset: not known.
  std::optional<double> bound = std::nullopt;
  /// What a contact showed counts in the next frame; false: frames are unrelated.
  bool memory = true;
};

/// Throws Error, its place being `where`, when a member is out of its range.
void check(const FrictionKnowledge& friction, std::string_view where);

/// How a contact's friction was learnt.
enum class FrictionSource : std::uint8_t {
  prior,         ///< not at all: it is no better known than before any reading
  given,         ///< by whoever asked
  observed,      ///< from the pillars of this frame
  carried_over,  ///< from those of earlier frames
};

/// "prior", "given", "observed", "carried_over".
[[nodiscard]] const char* name_of(FrictionSource source);

/// What is believed of the friction coefficient of a contact.
struct ContactFriction {
  double median = 0;
  double spread = 0;  ///< standard deviation of its logarithm
  FrictionSource source = FrictionSource::prior;
};

}  // namespace pillarfield
