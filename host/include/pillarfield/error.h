#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace pillarfield {

/// The only exception type that the library throws, apart from std::bad_alloc. Its text is one
/// printable() line: place, failure, remedy.
///
///     scenes/press.toml:12: key 'radius' is unknown; allowed: radius_mm, load_n
class Error : public std::runtime_error {
 public:
  /// `where` names a file, line, device or argument. `where` and `mend` may be empty.
  Error(std::string_view where, std::string_view what_failed, std::string_view mend = {});
};

}  // namespace pillarfield
