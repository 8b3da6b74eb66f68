#include "cli/interrupt.h"

#include <fmt/format.h>

#include "pillarfield/error.h"

namespace pillarfield::cli {

void stop_if_interrupted(std::uint64_t frames, const std::filesystem::path& output) {
  if (!is_interrupted()) return;
  throw Error(output.string(), fmt::format("interrupted after {} frames", frames),
              "an HDF5 output keeps them, under this name + \".part\"");
}

void stop_if_interrupted_before(const std::filesystem::path& output) {
  if (!is_interrupted()) return;
  throw Error(output.string(), "interrupted before it was written", "start again");
}

}  // namespace pillarfield::cli
