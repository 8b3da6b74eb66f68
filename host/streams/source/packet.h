#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "io/skin_constants.h"
#include "pillarfield/frame.h"
#include "pillarfield/stream_format.h"

namespace pillarfield {

/// Size and type of the frames of a stream.
struct FrameShape {
  SenselType type = SenselType::u8;
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;

  [[nodiscard]] std::size_t row_bytes() const { return cols * size_of(type); }
  [[nodiscard]] std::size_t bytes() const { return rows * row_bytes(); }
  /// The most bytes that follow the header of a packet.
  [[nodiscard]] std::size_t most_packet_bytes() const;
  bool operator==(const FrameShape&) const = default;
};

/// True if rows and columns are those of a skin, and no more than PILLARFIELD_MAX_SENSELS in all.
[[nodiscard]] bool is_size_allowed(const FrameShape& shape);

/// A packet as received; nothing in it is trusted. `bytes` is valid until the next one is received.
struct Packet {
  PillarfieldPacket header = {};
  std::span<const std::byte> bytes;  ///< after the header
  std::chrono::nanoseconds arrived{0};
};

[[nodiscard]] PillarfieldContent content_of(const PillarfieldPacket& header);

/// Size and type of the packet's frame; none if a member of the header is out of range or
/// contradicts another one.
[[nodiscard]] std::optional<FrameShape> shape_of(const PillarfieldPacket& header);

/// The constants that the header of a packet states; values out of range state nothing.
[[nodiscard]] StoredSkin stated_by(const PillarfieldPacket& header);

/// Those that a slot of a ring states.
[[nodiscard]] StoredSkin stated_by(const PillarfieldConstants& constants);

/// The type of readings that a packet or ring names as a PillarfieldReadingType.
[[nodiscard]] std::optional<SenselType> reading_type(std::uint32_t type);

/// Message about frames that are not those of the stream: "frames are 32 x 32, 40 x 60 expected".
[[nodiscard]] std::string mismatch_words(const FrameShape& came, const FrameShape& expected);

/// True if the packet, whose header has a shape, is as long as the header says and has the right
/// checksum.
[[nodiscard]] bool is_intact(const Packet& packet);

}  // namespace pillarfield
