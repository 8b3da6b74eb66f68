#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "pillarfield/live.h"

namespace pillarfield {

/// A kind of live sink, defined beside its class and listed in live_sink.cpp.
struct LiveSinkKind {
  std::string_view prefix;             ///< "udp:", or an extension ".mcap"
  const char* form = "";               ///< for messages: "udp:ADDRESS:PORT"
  bool stands_alone = false;           ///< the prefix without its colon is a whole target
  std::optional<int> least_port = {};  ///< an address with a port from this on follows the prefix
  /// Creates the sink for the whole target.
  std::unique_ptr<LiveSink> (*create)(const std::string& target,
                                      const LiveSinkInfo& info) = nullptr;
};

[[nodiscard]] std::span<const LiveSinkKind> live_sink_kinds();

/// A live sink that writes a file of create_force_sink().
[[nodiscard]] std::unique_ptr<LiveSink> create_live_file(const std::string& path,
                                                         const LiveSinkInfo& info);

}  // namespace pillarfield
