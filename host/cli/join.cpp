// pillarfield join: one file of forces from its parts.

#include <fmt/format.h>

#include "base/number_text.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/json_text.h"
#include "cli/progress.h"
#include "cli/warnings.h"
#include "pillarfield/force_parts.h"
#include "pillarfield/printable.h"

namespace pillarfield::cli {

namespace {

ForcePart joined_parts(const JoinCommand& command) {
  Progress progress("Joining", 0, command.quiet, "step");
  const auto show = [&](std::uint64_t done, std::uint64_t all) {
    stop_if_interrupted_before(command.output);
    progress.show(done, all);
  };
  return join_parts(command.output,
                    {.replace = command.replace, .read = command.read, .progress = show});
}

}  // namespace

void join(const JoinCommand& command) {
  check_outputs({}, {{command.output, OutputKind::forces}}, command.replace);
  const ForcePart joined = joined_parts(command);
  if (command.json) {
    fmt::print("{}\n", json_text({{"output", command.output},
                                  {"frames", joined.frames},
                                  {"parts", joined.count}}));
  } else if (!command.quiet) {
    fmt::print("Joined {}, {}, in {}\n", counted(joined.count, "part"),
               counted(joined.frames, "frame"), printable(command.output));
  }
}

}  // namespace pillarfield::cli
