#include "pillarfield/pitch.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <system_error>

namespace pillarfield {

std::string text_of(const Pitch& pitch) {
  if (pitch.is_square() || std::isnan(pitch.row_mm)) return fmt::format("{:g}", pitch.row_mm);
  return fmt::format("{:g}x{:g}", pitch.row_mm, pitch.col_mm);
}

std::optional<Pitch> parse_pitch(std::string_view text) {
  Pitch pitch;
  const char* const end = text.data() + text.size();
  auto parsed = std::from_chars(text.data(), end, pitch.row_mm);
  pitch.col_mm = pitch.row_mm;
  if (parsed.ec == std::errc{} && parsed.ptr != end && *parsed.ptr == 'x') {
    parsed = std::from_chars(parsed.ptr + 1, end, pitch.col_mm);
  }
  if (parsed.ec != std::errc{} || parsed.ptr != end || !is_valid(pitch)) return std::nullopt;
  return pitch;
}

bool is_valid(const Pitch& pitch) {
  const auto fits = [](double mm) { return mm >= 1e-3 && mm <= 1e3; };
  return fits(pitch.row_mm) && fits(pitch.col_mm);
}

}  // namespace pillarfield
