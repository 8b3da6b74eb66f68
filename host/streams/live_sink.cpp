#include "streams/live_sink.h"

#include <fmt/format.h>

#include <algorithm>

#include "pillarfield/error.h"
#include "pillarfield/printable.h"

namespace pillarfield {

std::span<const LiveSinkKind> live_sink_kinds() { return {}; }

std::unique_ptr<LiveSink> create_live_sink(const std::string& target, const LiveSinkInfo& info) {
  const auto kinds = live_sink_kinds();
  const auto kind = std::ranges::find_if(kinds, [&](const LiveSinkKind& candidate) {
    return candidate.prefix.starts_with('.') ? target.ends_with(candidate.prefix)
                                             : target.starts_with(candidate.prefix);
  });
  if (kind != kinds.end()) return kind->create(target, info);
  std::string forms;
  for (const LiveSinkKind& each : kinds) {
    forms += fmt::format("{}{}", forms.empty() ? "" : ", ", each.form);
  }
  throw Error(printable(target), "it names no live sink", fmt::format("give one of {}", forms));
}

}  // namespace pillarfield
