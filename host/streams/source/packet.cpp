#include "streams/source/packet.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

namespace pillarfield {
namespace {

constexpr std::size_t kChecksumBytes = 4;

bool is_checked(const PillarfieldPacket& header) {
  return (header.content & PILLARFIELD_CHECKED) != 0;
}

/// Bytes of readings that a header announces; none if its members contradict each other.
std::optional<std::size_t> reading_bytes(const PillarfieldPacket& header, const FrameShape& shape) {
  switch (content_of(header)) {
    case PILLARFIELD_FRAME:
      if (header.parts != 1) return std::nullopt;
      return shape.bytes();
    case PILLARFIELD_ROWS:
      if (header.count < 1 || header.count > shape.rows) return std::nullopt;
      if (header.first > shape.rows - header.count) return std::nullopt;
      return header.count * shape.row_bytes();
    case PILLARFIELD_CONSTANTS:
    case PILLARFIELD_END:
      return 0;
  }
  return std::nullopt;
}

std::uint32_t checksum_of(const PillarfieldPacket& header, std::span<const std::byte> bytes) {
  const auto* const head = reinterpret_cast<const Bytef*>(&header);
  const auto* const rest = reinterpret_cast<const Bytef*>(bytes.data());
  const uLong sum = crc32(0, head, sizeof header);
  return static_cast<std::uint32_t>(crc32_z(sum, rest, bytes.size()));
}

}  // namespace

std::optional<SenselType> reading_type(std::uint32_t type) {
  switch (type) {
    case PILLARFIELD_U8:
      return SenselType::u8;
    case PILLARFIELD_U16:
      return SenselType::u16;
    case PILLARFIELD_F32:
      return SenselType::f32;
    default:
      return std::nullopt;
  }
}

std::size_t FrameShape::most_packet_bytes() const { return bytes() + kChecksumBytes; }

bool is_size_allowed(const FrameShape& shape) {
  return std::min(shape.rows, shape.cols) >= 1 && std::max(shape.rows, shape.cols) <= kMaxSensels &&
         std::size_t{shape.rows} * shape.cols <= PILLARFIELD_MAX_SENSELS;
}

PillarfieldContent content_of(const PillarfieldPacket& header) {
  return static_cast<PillarfieldContent>(header.content & ~PILLARFIELD_CHECKED);
}

std::optional<FrameShape> shape_of(const PillarfieldPacket& header) {
  const auto type = reading_type(header.type);
  if (header.magic != PILLARFIELD_PACKET_MAGIC || !type || header.patch != 0) return std::nullopt;
  if ((header.content & ~PILLARFIELD_CHECKED) > PILLARFIELD_END) return std::nullopt;
  const FrameShape shape = {*type, header.rows, header.cols};
  if (!is_size_allowed(shape)) return std::nullopt;
  if (header.parts < 1 || header.parts > PILLARFIELD_MAX_PARTS || header.part >= header.parts) {
    return std::nullopt;
  }
  const auto bytes = reading_bytes(header, shape);
  const std::size_t checksum = is_checked(header) ? kChecksumBytes : 0;
  if (!bytes || header.bytes != *bytes + checksum) return std::nullopt;
  return shape;
}

namespace {

std::optional<SkinLayout> stated_layout(std::uint32_t layout) {
  if (layout == PILLARFIELD_PILLARS) return SkinLayout::pillars;
  if (layout == PILLARFIELD_SENSELS) return SkinLayout::sensels;
  return std::nullopt;
}

/// A constant that is stated; none if it is 0, or cannot be one.
std::optional<double> stated_constant(double value, double low, double high) {
  if (value >= low && value <= high) return value;
  return std::nullopt;
}

}  // namespace

StoredSkin stated_by(const PillarfieldConstants& constants) {
  constexpr double kLeast = std::numeric_limits<double>::min();
  const Pitch pitch_mm = {constants.pitch_y_mm, constants.pitch_x_mm};
  return {.sensel_pitch_mm = is_valid(pitch_mm) ? std::optional(pitch_mm) : std::nullopt,
          .counts_per_newton = stated_constant(constants.counts_per_newton, kMinCountsPerNewton,
                                               kMaxCountsPerNewton),
          .threshold_counts = stated_constant(constants.threshold_counts, kLeast, kMaxCounts),
          .full_scale_counts = stated_constant(constants.full_scale_counts, kLeast, kMaxCounts),
          .layout = stated_layout(constants.layout),
          .falling = constants.mirrored == 1};
}

StoredSkin stated_by(const PillarfieldPacket& header) {
  const PillarfieldContent content = content_of(header);
  if (content != PILLARFIELD_FRAME && content != PILLARFIELD_CONSTANTS) return {};
  constexpr std::uint32_t kPitchBits = 30;
  constexpr std::uint32_t kPitchMask = (1U << kPitchBits) - 1;
  PillarfieldConstants constants = {};
  constants.layout = header.first >> kPitchBits;
  constants.pitch_x_mm = constants.pitch_y_mm = 1e-6 * (header.first & kPitchMask);
  constants.counts_per_newton = static_cast<double>(std::bit_cast<float>(header.count));
  return stated_by(constants);
}

std::string mismatch_words(const FrameShape& came, const FrameShape& expected) {
  if (came.rows == expected.rows && came.cols == expected.cols) {
    return fmt::format("frames are {}, {} expected", name_of(came.type), name_of(expected.type));
  }
  return fmt::format("frames are {} x {}, {} x {} expected", came.rows, came.cols, expected.rows,
                     expected.cols);
}

bool is_intact(const Packet& packet) {
  if (packet.bytes.size() != packet.header.bytes) return false;
  if (!is_checked(packet.header)) return true;
  const auto readings = packet.bytes.first(packet.bytes.size() - kChecksumBytes);
  std::uint32_t checksum = 0;
  std::memcpy(&checksum, packet.bytes.last(kChecksumBytes).data(), kChecksumBytes);
  return checksum == checksum_of(packet.header, readings);
}

}  // namespace pillarfield
