// pillarfield join: one file of forces from its parts.

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/json_text.h"
#include "cli/number_text.h"
#include "cli/progress.h"
#include "cli/warnings.h"
#include "pillarfield/force_parts.h"
#include "pillarfield/printable.h"

namespace pillarfield::cli {

namespace {

JoinedParts joined_parts(const JoinCommand& command) {
  Progress progress("Joining", 0, command.quiet, "step");
  const auto show = [&](std::uint64_t done, std::uint64_t all) {
    stop_if_interrupted_before(command.output);
    progress.show(done, all);
  };
  return join_parts(command.output, {.copy = command.copy,
                                     .allow_lost = command.allow_missing,
                                     .replace = command.replace,
                                     .read = command.read,
                                     .progress = show});
}

}  // namespace

void join(const JoinCommand& command) {
  check_outputs({}, {{command.output, OutputKind::forces}}, command.replace);
  const JoinedParts joined = joined_parts(command);
  if (command.json) {
    nlohmann::ordered_json lost = nlohmann::ordered_json::array();
    for (const LostPart& part : joined.lost) lost.push_back(part.index);
    fmt::print("{}\n", json_text({{"output", command.output},
                                  {"frames", joined.frames},
                                  {"parts", joined.parts},
                                  {"lost_parts", lost},
                                  {"copied", command.copy}}));
    return;
  }
  print_file_warnings(command.output, sentences_about(joined.lost));
  if (command.quiet) return;
  fmt::print("Joined {} of {} parts, {}, in {}\n", joined.parts - joined.lost.size(), joined.parts,
             counted(joined.frames, "frame"), printable(command.output));
  if (!command.copy) {
    fmt::print("Its values stay in {}\n",
               printable(part_file(command.output, 1).parent_path().string()));
  }
}

}  // namespace pillarfield::cli
