#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace pillarfield {

/// Writes a message in CDR as ROS 2 does (OMG DDSI-RTPS 2.3, 10.2; plain CDR version 1,
/// little-endian): 4 bytes of encapsulation, then the members, each aligned to its own size from
/// the end of the encapsulation.
class CdrWriter {
 public:
  /// Starts a message in `out`, which loses its content and keeps its memory.
  explicit CdrWriter(std::vector<std::byte>& out) : out_(out) {
    out_.assign({std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}});
  }

  template <class T>
  requires std::is_arithmetic_v<T>
  void put(T value) {
    static_assert(std::endian::native == std::endian::little);
    align(sizeof(T));
    append(&value, sizeof value);
  }
  template <class... T>
  void put_all(T... values) {
    (put(values), ...);
  }
  void put(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size() + 1));
    append(text.data(), text.size());
    out_.push_back(std::byte{0});
  }
  /// The length of a sequence, whose elements follow.
  void put_length(std::size_t elements) { put(static_cast<std::uint32_t>(elements)); }
  void put_bytes(std::span<const std::byte> bytes) {
    put_length(bytes.size());
    append(bytes.data(), bytes.size());
  }
  /// Space for a sequence of bytes, to be filled before the next call.
  [[nodiscard]] std::byte* put_space(std::size_t bytes) {
    put_length(bytes);
    const std::size_t start = out_.size();
    out_.resize(start + bytes);
    return out_.data() + start;
  }

 private:
  static constexpr std::size_t kEncapsulation = 4;

  void align(std::size_t size) {
    while ((out_.size() - kEncapsulation) % size != 0) out_.push_back(std::byte{0});
  }
  void append(const void* data, std::size_t bytes) {
    const std::size_t start = out_.size();
    out_.resize(start + bytes);
    if (bytes > 0) std::memcpy(out_.data() + start, data, bytes);
  }

  std::vector<std::byte>& out_;
};

}  // namespace pillarfield
