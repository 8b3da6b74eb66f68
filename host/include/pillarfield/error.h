#pragma once

#include <cstddef>
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

  /// The parts of the text, valid as long as the error; empty where they were not given.
  [[nodiscard]] std::string_view place() const;
  [[nodiscard]] std::string_view failure() const;
  [[nodiscard]] std::string_view mend() const;

 private:
  struct Parts;
  explicit Error(const Parts& parts);

  std::size_t place_length_;
  std::size_t failure_begin_;
  std::size_t failure_length_;
};

}  // namespace pillarfield
