#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace pillarfield::cli {

/// Returns JSON on one line. Invalid UTF-8, as in file names, becomes replacement characters.
[[nodiscard]] inline std::string json_text(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace pillarfield::cli
