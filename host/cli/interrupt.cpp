#include "cli/interrupt.h"

#include <fmt/format.h>

#include "base/number_text.h"
#include "pillarfield/error.h"

namespace pillarfield::cli {

void stop_if_interrupted(std::uint64_t frames, const std::filesystem::path& output) {
  if (!is_interrupted()) return;
  throw Error(output.string(), "interrupted after " + counted(frames, "frame"),
              "an HDF5 output keeps them, under this name + \".part\"");
}

void stop_if_interrupted_before(const std::filesystem::path& output) {
  if (!is_interrupted()) return;
  throw Error(output.string(), "interrupted before it was written", "start again");
}

}  // namespace pillarfield::cli
