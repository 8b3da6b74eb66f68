#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "pillarfield/stream_format.h"

namespace pillarfield::cli {

/// Packets one after the other, as a network card leaves them in memory.
class PacketStore {
 public:
  void clear() {
    packets_.clear();
    bytes_.clear();
  }
  void add(const PillarfieldPacket& header, std::span<const std::byte> readings, bool lost) {
    packets_.push_back({header, bytes_.size(), lost});
    bytes_.insert(bytes_.end(), readings.begin(), readings.end());
  }

  struct Entry {
    PillarfieldPacket header;
    std::size_t first_byte = 0;
    bool lost = false;
  };

  [[nodiscard]] std::span<const Entry> packets() const { return packets_; }
  [[nodiscard]] std::span<const std::byte> readings(const Entry& packet) const {
    return std::span(bytes_).subspan(packet.first_byte, packet.header.bytes);
  }
  /// Bytes of all packets, headers included.
  [[nodiscard]] std::size_t bytes() const {
    return bytes_.size() + packets_.size() * sizeof(PillarfieldPacket);
  }

 private:
  std::vector<Entry> packets_;
  std::vector<std::byte> bytes_;
};

}  // namespace pillarfield::cli
