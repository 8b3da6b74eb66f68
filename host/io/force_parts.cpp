#include "pillarfield/force_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "pillarfield/error.h"
#include "pillarfield/force_file.h"

namespace pillarfield {
namespace {

std::uint64_t step_of(const Checkpoints& checkpoints) {
  return std::max<std::uint64_t>(checkpoints.every, 1);
}

}  // namespace

std::uint64_t most_parts(std::uint64_t frames, const Checkpoints& checkpoints) {
  const std::uint64_t step = step_of(checkpoints);
  return std::min(frames / step + (frames % step != 0 ? 1 : 0), kMostParts);
}

void check(const ForcePart& part, const std::string& where) {
  const std::uint64_t most = most_parts(part.frames, part.checkpoints);
  if (part.count < 1 || part.count > most) {
    throw Error(where,
                fmt::format("{} frames{} cannot be split into {} parts", part.frames,
                            part.checkpoints.every > 0
                                ? fmt::format(" with checkpoints every {}", part.checkpoints.every)
                                : "",
                            part.count),
                most > 0 ? fmt::format("give 1 to {}", most) : "record some frames");
  }
  if (part.index >= 1 && part.index <= part.count) return;
  throw Error(where, fmt::format("there is no part {} of {}", part.index, part.count),
              fmt::format("parts count from 1 to {}", part.count));
}

FrameRange frames_of(const ForcePart& part) {
  const std::uint64_t step = step_of(part.checkpoints);
  const std::uint64_t steps = part.frames / step + (part.frames % step != 0 ? 1 : 0);
  const auto start = [&](std::uint64_t index) {
    return std::min(index * steps / part.count * step, part.frames);
  };
  return {start(part.index - 1), start(part.index)};
}

std::filesystem::path part_file(const std::filesystem::path& output, std::uint64_t index) {
  std::filesystem::path folder = output;
  folder += ".parts";
  return folder / fmt::format("{:05}.h5", index);
}

bool holds_part(const std::filesystem::path& file, const ForcePart& part) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(file, failed)) return false;
  try {
    const ForceFileReader reader(file);
    return reader.info().part == part && reader.frames() == frames_of(part).frames();
  } catch (const Error&) {
    return false;
  }
}

void require_same_division(const std::filesystem::path& file, const ForcePart& part) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(file, failed)) return;
  std::optional<ForcePart> held;
  try {
    held = ForceFileReader(file).info().part;
  } catch (const Error&) {
    return;  // Damaged: it is solved again.
  }
  if (!held || held->fingerprint != part.fingerprint) return;
  if (held->count == part.count && held->checkpoints == part.checkpoints) return;
  throw Error(
      file.string(),
      fmt::format("holds part {} of {} of this solve, not of {}", held->index, held->count,
                  part.count),
      fmt::format("give --part K/{} with its checkpoints, or remove its folder", held->count));
}

}  // namespace pillarfield
