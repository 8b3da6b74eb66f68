#include "cli/parts/share.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "cli/parts/launcher.h"
#include "pillarfield/error.h"

namespace pillarfield::cli {
namespace {

/// K and N of "K/N".
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

Rank rank_of(bool is_needed) {
  if (const auto rank = launcher_rank()) return *rank;
  if (!is_needed) return {};
  throw Error("--parts auto", "no launcher gives this process a rank",
              "start it with mpirun, srun or as an array job, or give --parts N");
}

}  // namespace

bool is_part(const std::string& text) { return part_of(text).has_value(); }

Checkpoints checkpoints_of(const PartOptions& options) {
  const std::uint64_t every = options.checkpoint_every.value_or(0);
  return {every, options.warm_up.value_or(every / 10)};
}

std::optional<PartShare> share_of(const PartOptions& options, std::uint64_t most) {
  if (!options.part.empty()) {
    const auto [index, count] = *part_of(options.part);
    return PartShare{count, {index}};
  }
  if (options.parts.empty()) return std::nullopt;
  const bool is_auto = options.parts == "auto";
  const Rank rank = rank_of(is_auto);
  PartShare share;
  // With more processes than frames, some have nothing to do.
  share.count = is_auto ? std::min(rank.size, most) : std::stoull(options.parts);
  for (std::uint64_t index = rank.rank; index < share.count; index += rank.size) {
    share.indices.push_back(index + 1);
  }
  return share;
}

}  // namespace pillarfield::cli
