#include "streams/source/packet_parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace pillarfield {
namespace {

constexpr std::size_t kReadBytes = 1 << 16;
constexpr std::size_t kHeaderBytes = sizeof(PillarfieldPacket);

/// PILLARFIELD_PACKET_MAGIC, little-endian.
constexpr std::string_view kMagic = "PFR1";

std::size_t find_magic_in(std::string_view text, std::size_t from) {
  const void* const found =
      memmem(text.data() + from, text.size() - from, kMagic.data(), kMagic.size());
  if (found == nullptr) return text.size();
  return static_cast<std::size_t>(static_cast<const char*>(found) - text.data());
}

PillarfieldPacket header_at(std::string_view text, std::size_t place) {
  PillarfieldPacket header;
  std::memcpy(&header, text.substr(place, kHeaderBytes).data(), kHeaderBytes);
  return header;
}

}  // namespace

PacketParser::PacketParser() : buffer_(2 * kReadBytes) {}

std::span<std::byte> PacketParser::space() {
  if (buffer_.size() - end_ < kReadBytes) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, waiting());
    end_ = waiting();
    begin_ = 0;
  }
  return std::span(buffer_).subspan(end_);
}

void PacketParser::commit(std::size_t bytes, std::chrono::nanoseconds arrived) {
  end_ += bytes;
  arrived_ = arrived;
  finished_ = false;
}

std::string_view PacketParser::text() const {
  return {reinterpret_cast<const char*>(buffer_.data() + begin_), waiting()};
}

void PacketParser::skip(std::size_t bytes) {
  if (bytes > 0 && !std::exchange(in_rubbish_, true)) ++invalid_;
  begin_ += bytes;
  rubbish_ += bytes;
}

std::string PacketParser::complaint() const {
  constexpr std::uint64_t kMany = 2000;
  if (rubbish_ < kMany) return {};
  return fmt::format("{:.3g} kB came, no packet", 1e-3 * static_cast<double>(rubbish_));
}

bool PacketParser::find_magic() {
  const std::size_t place = find_magic_in(text(), 0);
  if (place < waiting()) {
    skip(place);
    return true;
  }
  // The last bytes may be the first ones of a magic.
  std::size_t kept = finished_ ? 0 : std::min(waiting(), kMagic.size() - 1);
  while (!kMagic.starts_with(text().substr(waiting() - kept))) --kept;
  skip(waiting() - kept);
  return false;
}

/// Grows the buffer, until the shape is final, for the packets of another shape.
void PacketParser::make_room(const FrameShape& shape) {
  const std::size_t most = kHeaderBytes + shape.most_packet_bytes() + kReadBytes;
  if (buffer_.size() < most) buffer_.resize(most);
}

/// The packet's bytes that belong to it, header included: all, or those before the header of
/// another packet, which shows that this one was cut short; only the magic if the checksum is
/// wrong. None: bytes to come will tell.
std::optional<std::size_t> PacketParser::valid_bytes(const Packet& packet) {
  const std::size_t all = kHeaderBytes + packet.bytes.size();
  if ((packet.header.content & PILLARFIELD_CHECKED) != 0) {
    checked_ += all;
    return is_intact(packet) ? all : kMagic.size();
  }
  const std::string_view bytes = text();
  for (std::size_t place = kHeaderBytes;; ++place) {
    place = find_magic_in(bytes, place);
    if (place >= all) return all;
    const bool has_header = bytes.size() - place >= kHeaderBytes;
    if (!has_header && !finished_) return std::nullopt;
    if (has_header && fits(shape_of(header_at(bytes, place)))) return place;
  }
}

/// Looks at the bytes from a magic on; true if they are a packet, which is taken.
PacketParser::Found PacketParser::find_packet(Packet& packet) {
  const Found unfinished = finished_ ? Found::rubbish : Found::more_needed;
  if (waiting() < kHeaderBytes) return unfinished;
  packet.header = header_at(text(), 0);
  const auto shape = shape_of(packet.header);
  if (!fits(shape)) {
    if (shape) other_ = shape;
    return Found::rubbish;
  }
  make_room(*shape);
  const std::size_t all = kHeaderBytes + packet.header.bytes;
  if (waiting() < all) return unfinished;
  packet.bytes = std::span(buffer_).subspan(begin_ + kHeaderBytes, packet.header.bytes);
  const auto valid = valid_bytes(packet);
  if (!valid) return Found::more_needed;
  if (*valid < all) {
    in_rubbish_ = false;  // It counts for itself.
    skip(*valid);
    in_rubbish_ = *valid == kMagic.size();
    return Found::cut_short;
  }
  begin_ += all;
  in_rubbish_ = false;
  return Found::packet;
}

bool PacketParser::next(Packet& packet) {
  checked_ = 0;
  while (!is_busy() && find_magic()) {
    switch (find_packet(packet)) {
      case Found::packet:
        packet.arrived = arrived_;
        rubbish_ = 0;
        return true;
      case Found::more_needed:
        return false;
      case Found::rubbish:
        skip(kMagic.size());
        break;
      case Found::cut_short:
        break;
    }
  }
  return false;
}

}  // namespace pillarfield
