#pragma once

#include <memory>
#include <optional>
#include <string>

#include "pillarfield/skin.h"
#include "streams/source/byte_parser.h"

namespace pillarfield {

/// What follows `serial:`.
struct SerialAddress {
  std::string device;
  std::unique_ptr<ByteParser> parser;  ///< of its protocol
  /// What stands on the sensels of boards with this protocol; unset: what the options say.
  std::optional<SkinLayout> layout = {};
};

/// Reads "DEVICE", whose bytes are packets, or "DEVICE?protocol=NAME&rows=ROWS&cols=COLS". Throws
/// Error, naming the source, for options that are unknown, missing or out of range.
[[nodiscard]] SerialAddress serial_address(const std::string& text);

}  // namespace pillarfield
