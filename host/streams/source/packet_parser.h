#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "streams/source/byte_parser.h"

namespace pillarfield {

/// Finds packets as docs/stream_format.md describes them.
class PacketParser final : public ByteParser {
 public:
  PacketParser();

  void prepare(const FrameShape& shape) override { shape_ = shape; }
  [[nodiscard]] std::span<std::byte> space() override;
  void commit(std::size_t bytes, std::chrono::nanoseconds arrived) override;
  bool next(Packet& packet) override;

  /// True if next() returned false because it had computed checksums of kMostChecked bytes or more.
  [[nodiscard]] bool is_busy() const override { return checked_ >= kMostChecked; }
  static constexpr std::size_t kMostChecked = std::size_t{4} << 20;  ///< about a millisecond

  void finish() override { finished_ = true; }
  [[nodiscard]] std::uint64_t invalid() const override { return invalid_; }
  [[nodiscard]] std::optional<FrameShape> other() const override { return other_; }
  [[nodiscard]] std::string complaint() const override;

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
  std::size_t checked_ = 0;              ///< bytes of checksums in this call of next()
  std::chrono::nanoseconds arrived_{0};  ///< of the last bytes
  std::optional<FrameShape> shape_;
  std::optional<FrameShape> other_;  ///< of the latest header that is sound
  bool finished_ = false;
  bool in_rubbish_ = true;  ///< at first the rest of a packet, which is none of its own
  std::uint64_t invalid_ = 0;
  std::uint64_t rubbish_ = 0;  ///< bytes since the last packet that are none
};

}  // namespace pillarfield
