#pragma once

#include <zlib.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/input_file.h"

namespace pillarfield {

/// Most bytes that compressed data are inflated to in memory: 64 times as many as they have, but
/// always 256 MiB, and never more than 1 GiB.
inline constexpr std::uint64_t kMostInflatedBytes = std::uint64_t{1} << 30;
[[nodiscard]] constexpr std::uint64_t most_inflated(std::uint64_t compressed_bytes) {
  return std::clamp(64 * std::min(compressed_bytes, kMostInflatedBytes), kMostInflatedBytes / 4,
                    kMostInflatedBytes);
}
/// Bytes that a byte of deflated data stands for, at most.
inline constexpr std::uint64_t kMostDeflateRatio = 1032;

/// Inflates `left` bytes of a file from byte `at` on, with header and checksum of zlib (RFC 1950),
/// from first to last, by 64 KiB at a time.
class Inflater {
 public:
  /// `file` must outlive it.
  Inflater(const InputFile& file, std::uint64_t at, std::uint64_t left);
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Fills `bytes` and returns how many of them there are. Throws Error if the data are damaged, or
  /// is_interrupted() becomes true.
  std::size_t read(std::span<std::byte> bytes);

 private:
  const InputFile& file_;
  std::uint64_t at_;
  std::uint64_t left_;
  z_stream stream_ = {};
  std::vector<std::byte> input_ = std::vector<std::byte>(64U << 10U);
  bool has_ended_ = false;
};

}  // namespace pillarfield
