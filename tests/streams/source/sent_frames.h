#pragma once

// Frames with known readings, as a driver sends them, and plans that damage them on the way.

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "streams/source/packet.h"

namespace pillarfield::streams_test {

/// A packet as bytes, and what it was before it was damaged.
struct SentPacket {
  PillarfieldPacket header = {};
  std::string readings;
  bool intact = true;

  [[nodiscard]] std::string bytes() const {
    return std::string(reinterpret_cast<const char*>(&header), sizeof header) + readings;
  }
};

inline PillarfieldPacket header_of(const FrameShape& shape, std::uint64_t sequence) {
  PillarfieldPacket header = {};
  header.magic = PILLARFIELD_PACKET_MAGIC;
  header.type = static_cast<std::uint16_t>(shape.type == SenselType::u8    ? PILLARFIELD_U8
                                           : shape.type == SenselType::u16 ? PILLARFIELD_U16
                                                                           : PILLARFIELD_F32);
  header.rows = shape.rows;
  header.cols = shape.cols;
  header.session = 7;
  header.sequence = sequence;
  header.time_ns = 1'000'000 * (sequence + 1);
  header.parts = 1;
  return header;
}

/// Bytes of the readings of a frame; other ones for each sequence.
inline std::string readings_of(const FrameShape& shape, std::uint64_t sequence) {
  std::minstd_rand random(static_cast<unsigned>(sequence * 7919 + 1));
  std::string bytes(shape.bytes(), '\0');
  for (char& byte : bytes) byte = static_cast<char>(random() >> 8 & 0x3f);
  return bytes;
}

inline SentPacket frame_packet(const FrameShape& shape, std::uint64_t sequence) {
  SentPacket packet = {header_of(shape, sequence), readings_of(shape, sequence)};
  packet.header.bytes = static_cast<std::uint32_t>(packet.readings.size());
  return packet;
}

/// A frame in parts of whole rows, as even as possible.
inline std::vector<SentPacket> row_packets(const FrameShape& shape, std::uint64_t sequence,
                                           std::uint32_t parts) {
  const std::string all = readings_of(shape, sequence);
  std::vector<SentPacket> packets;
  for (std::uint32_t part = 0; part < parts; ++part) {
    SentPacket packet = {header_of(shape, sequence), {}};
    packet.header.content = PILLARFIELD_ROWS;
    packet.header.part = part;
    packet.header.parts = parts;
    packet.header.first = shape.rows * part / parts;
    packet.header.count = shape.rows * (part + 1) / parts - packet.header.first;
    packet.readings = all.substr(packet.header.first * shape.row_bytes(),
                                 packet.header.count * shape.row_bytes());
    packet.header.bytes = static_cast<std::uint32_t>(packet.readings.size());
    packets.push_back(packet);
  }
  return packets;
}

/// Adds the checksum.
inline SentPacket checked(SentPacket packet) {
  packet.header.content |= PILLARFIELD_CHECKED;
  packet.header.bytes += 4;
  const std::string bytes = packet.bytes();
  const auto sum = static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
  packet.readings.append(reinterpret_cast<const char*>(&sum), 4);
  return packet;
}

/// Makes a packet of rows invalid.
inline SentPacket damaged(SentPacket packet, std::mt19937& random) {
  PillarfieldPacket& header = packet.header;
  packet.intact = false;
  switch (random() % 12) {
    case 0:
      header.magic ^= 1U << random() % 32;
      break;
    case 1:
      header.content = static_cast<std::uint16_t>(4 + random() % 200);
      break;
    case 2:
      header.type = static_cast<std::uint16_t>(4 + random() % 200);
      break;
    case 3:
      header.rows ^= 1U << random() % 32;
      break;
    case 4:
      header.cols = static_cast<std::uint32_t>(random());
      break;
    case 5:
      header.part = header.parts + static_cast<std::uint32_t>(random() % 3);
      break;
    case 6:
      header.bytes += 1 + static_cast<std::uint32_t>(random());
      break;
    case 7:  // only ROWS
      header.first = header.rows - header.count + 1 + static_cast<std::uint32_t>(random() % 3);
      break;
    case 8:
      header.patch = 1;
      break;
    case 9:  // only CHECKED
      if ((header.content & PILLARFIELD_CHECKED) != 0) {
        packet.readings[random() % packet.readings.size()] ^= 1;
        break;
      }
      [[fallthrough]];
    case 10:
      packet.readings.resize(packet.readings.size() - 1 - random() % 20);
      break;
    default:
      packet.readings += "more";
      break;
  }
  return packet;
}

}  // namespace pillarfield::streams_test
