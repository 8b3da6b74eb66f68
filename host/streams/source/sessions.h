#pragma once

#include <array>
#include <chrono>
#include <cstdint>

namespace pillarfield {

/// Follows the sessions of a sensor: the newest one counts. One that it replaced counts again only
/// when the newest has sent nothing for a second.
class Sessions {
 public:
  enum class Kind : std::uint8_t { current, started, replaced };

  /// What a packet of `session` belongs to. The first session of all is `current`.
  Kind classify(std::uint64_t session, std::chrono::nanoseconds arrived);

 private:
  [[nodiscard]] bool was_replaced(std::uint64_t session) const;

  std::array<std::uint64_t, 8> replaced_ = {};
  std::uint64_t replacements_ = 0;
  std::uint64_t current_ = 0;
  bool known_ = false;
  std::chrono::nanoseconds heard_{0};
};

}  // namespace pillarfield
