#include "streams/live_sink.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

#include "io/force_sink.h"
#include "pillarfield/error.h"
#include "pillarfield/printable.h"
#include "streams/sink/address.h"

namespace pillarfield {

// Each is defined beside its sink.
LiveSinkKind mcap_sink_kind();
LiveSinkKind ring_sink_kind();
LiveSinkKind udp_sink_kind();
LiveSinkKind foxglove_sink_kind();
LiveSinkKind web_sink_kind();

std::span<const LiveSinkKind> live_sink_kinds() {
  static const std::array kinds = {mcap_sink_kind(), ring_sink_kind(), udp_sink_kind(),
                                   foxglove_sink_kind(), web_sink_kind()};
  return kinds;
}

namespace {

/// The kind of a target; null: a file of forces. Throws Error for another target.
const LiveSinkKind* kind_of_sink(const std::string& target) {
  const auto kinds = live_sink_kinds();
  const auto kind = std::ranges::find_if(kinds, [&](const LiveSinkKind& candidate) {
    if (candidate.prefix.starts_with('.')) return target.ends_with(candidate.prefix);
    return target.starts_with(candidate.prefix) ||
           (candidate.stands_alone && target + ":" == candidate.prefix);
  });
  if (kind != kinds.end()) return &*kind;
  if (format_by_extension(target, OutputKind::forces) != nullptr) return nullptr;
  std::string forms;
  for (const LiveSinkKind& each : kinds) forms += fmt::format("{}, ", each.form);
  throw Error(printable(target), "it names no live sink",
              fmt::format("give one of {}or a file {}", forms, endings_of(OutputKind::forces)));
}

}  // namespace

void check_live_sink(const std::string& target) {
  const LiveSinkKind* const kind = kind_of_sink(target);
  if (kind == nullptr || !kind->least_port) return;
  if (kind->stands_alone && target.size() <= kind->prefix.size()) return;
  static_cast<void>(
      address_of(std::string_view(target).substr(kind->prefix.size()), target, *kind->least_port));
}

std::unique_ptr<LiveSink> create_live_sink(const std::string& target, const LiveSinkInfo& info) {
  const LiveSinkKind* const kind = kind_of_sink(target);
  return kind == nullptr ? create_live_file(target, info) : kind->create(target, info);
}

}  // namespace pillarfield
