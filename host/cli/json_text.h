#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace pillarfield::cli {

/// JSON on one line. Bytes that are not UTF-8, as names of files may have, become replacement
/// characters; dump() would throw.
[[nodiscard]] inline std::string json_text(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace pillarfield::cli
