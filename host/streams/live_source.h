#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "pillarfield/live.h"

namespace pillarfield {

/// A kind of live source, defined beside its stream and listed in live_source.cpp.
struct LiveSourceKind {
  std::string_view prefix;  ///< "udp:"; "-" alone is standard input
  const char* form = "";    ///< for messages: "udp:ADDRESS:PORT"
  /// Opens the source; `rest` is what follows the prefix.
  std::unique_ptr<FrameStream> (*open)(const std::string& rest,
                                       const LiveSourceOptions& options) = nullptr;
};

[[nodiscard]] std::span<const LiveSourceKind> live_source_kinds();

}  // namespace pillarfield
