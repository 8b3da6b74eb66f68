#pragma once

#include <memory>
#include <string>

#include "pillarfield/live.h"

namespace pillarfield {

/// A live sink that writes a file of create_force_sink().
[[nodiscard]] std::unique_ptr<LiveSink> create_live_file(const std::string& path,
                                                         const LiveSinkInfo& info);

}  // namespace pillarfield
