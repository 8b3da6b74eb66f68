#include "cli/part_share.h"

#include <charconv>

namespace pillarfield::cli {

std::optional<std::pair<std::uint64_t, std::uint64_t>> part_of(const std::string& text) {
  std::uint64_t index = 0;
  std::uint64_t count = 0;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, index);
  if (first.ec != std::errc{} || first.ptr == end || *first.ptr != '/') return std::nullopt;
  const auto second = std::from_chars(first.ptr + 1, end, count);
  const bool fits = second.ec == std::errc{} && second.ptr == end && index >= 1 && index <= count &&
                    count <= kMostParts;
  return fits ? std::optional(std::pair(index, count)) : std::nullopt;
}

Checkpoints checkpoints_of(const PartOptions& options) {
  const std::uint64_t every = options.checkpoint_every.value_or(0);
  return {every, options.warm_up.value_or(every / 10)};
}

}  // namespace pillarfield::cli
