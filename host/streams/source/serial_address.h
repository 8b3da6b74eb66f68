#pragma once

#include <memory>
#include <string>

#include "streams/source/byte_parser.h"

namespace pillarfield {

/// The address after `serial:`.
struct SerialAddress {
  std::string device;
  std::unique_ptr<ByteParser> parser;  ///< of its protocol
};

/// Reads "DEVICE", whose bytes are packets, or "DEVICE?protocol=NAME&rows=ROWS&cols=COLS". Throws
/// Error, naming the source, for options that are unknown, missing or out of range.
[[nodiscard]] SerialAddress serial_address(const std::string& text);

}  // namespace pillarfield
