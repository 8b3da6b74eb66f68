#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "streams/source/packet.h"

namespace pillarfield {

/// Finds packets in a stream of bytes, and finds them again after damage.
///
///     while (!parser.next(packet)) {
///       if (parser.is_busy()) return;  // to look at the time, and call next() again
///       parser.commit(read(fd, parser.space()), steady_now());
///     }
class ByteParser {
 public:
  ByteParser() = default;
  virtual ~ByteParser() = default;
  ByteParser(const ByteParser&) = delete;
  ByteParser& operator=(const ByteParser&) = delete;

  /// Accepts only packets shaped like the last packet from now on, and allocates no more.
  virtual void prepare(const FrameShape& shape) = 0;

  /// Memory for bytes to come, not empty; next() must have returned false, and is_busy() too.
  [[nodiscard]] virtual std::span<std::byte> space() = 0;
  /// Takes the first bytes of space(), which arrived at this time.
  virtual void commit(std::size_t bytes, std::chrono::nanoseconds arrived) = 0;

  /// The next packet; false: more bytes are needed, or is_busy(). Its bytes are valid until the
  /// following call of space().
  virtual bool next(Packet& packet) = 0;

  /// True if next() returned false although it did not look at all bytes.
  [[nodiscard]] virtual bool is_busy() const { return false; }

  /// Declares the bytes so far all that there are: next() treats an unfinished packet as invalid.
  virtual void finish() = 0;

  /// Runs of bytes that are not a packet.
  [[nodiscard]] virtual std::uint64_t invalid() const = 0;
  /// Shape of the latest packets that are sound, but of other frames than those of prepare().
  [[nodiscard]] virtual std::optional<FrameShape> other() const { return std::nullopt; }
  /// Reason why many bytes held no packet, for the user who waits for one; empty: unknown.
  [[nodiscard]] virtual std::string complaint() const { return {}; }
};

}  // namespace pillarfield
