#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace pillarfield {

/// The one exception type of the library. Its text is a single printable() line of three parts:
/// where it happened, what failed, and how to mend it.
///
///     scenes/press.toml:12: key 'radius' is unknown; allowed: radius_mm, load_n
class Error : public std::runtime_error {
 public:
  /// `where` names a file, line, device or argument; it may be empty. `mend` may be empty where
  /// the failure itself tells what to do.
  Error(std::string_view where, std::string_view what_failed, std::string_view mend = {});
};

}  // namespace pillarfield
