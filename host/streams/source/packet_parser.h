#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "streams/source/packet.h"

namespace pillarfield {

/// Finds packets in a stream of bytes, and finds them again after rubbish.
///
///     while (!parser.next(packet)) {
///       if (parser.is_busy()) return;  // to look at the time, and call next() again
///       parser.commit(read(fd, parser.space()));
///     }
class PacketParser {
 public:
  PacketParser();

  /// Accepts only packets of this shape, that of the last packet, from now on, and allocates no
  /// more.
  void prepare(const FrameShape& shape) { shape_ = shape; }

  /// Memory for bytes to come, not empty; next() must have returned false, and is_busy() too.
  [[nodiscard]] std::span<std::byte> space();
  /// Takes the first bytes of space().
  void commit(std::size_t bytes);

  /// The next packet, without its time of arrival; false: more bytes are needed, or is_busy(). Its
  /// bytes are valid until the following call of space().
  bool next(Packet& packet);

  /// Whether next() returned false because it had computed checksums of kMostChecked bytes or more.
  [[nodiscard]] bool is_busy() const { return checked_ >= kMostChecked; }
  static constexpr std::size_t kMostChecked = std::size_t{4} << 20;  ///< about a millisecond

  /// Declares the bytes so far all that there are: next() takes an unfinished packet for rubbish.
  void finish() { finished_ = true; }

  /// Runs of bytes that are not a packet.
  [[nodiscard]] std::uint64_t invalid() const { return invalid_; }
  void clear_counts() { invalid_ = 0; }
  /// Shape of the latest header that is sound, but of other frames than those of prepare().
  [[nodiscard]] const std::optional<FrameShape>& other() const { return other_; }

 private:
  enum class Found : std::uint8_t { packet, more_needed, rubbish, cut_short };

  [[nodiscard]] std::size_t waiting() const { return end_ - begin_; }
  [[nodiscard]] std::string_view text() const;
  bool find_magic();
  void skip(std::size_t bytes);
  [[nodiscard]] bool fits(const std::optional<FrameShape>& shape) const {
    return shape && (!shape_ || shape == shape_);
  }
  void make_room(const FrameShape& shape);
  [[nodiscard]] std::optional<std::size_t> valid_bytes(const Packet& packet);
  Found find_packet(Packet& packet);

  std::vector<std::byte> buffer_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::size_t checked_ = 0;  ///< bytes of checksums in this call of next()
  std::optional<FrameShape> shape_;
  std::optional<FrameShape> other_;
  bool finished_ = false;
  bool in_rubbish_ = false;
  std::uint64_t invalid_ = 0;
};

}  // namespace pillarfield
