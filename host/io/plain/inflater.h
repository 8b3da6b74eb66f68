#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

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

/// Compressed bytes of a file.
struct DeflatedData {
  std::uint64_t at = 0;
  std::uint64_t bytes = 0;
  bool has_zlib_header = false;  ///< and a checksum (RFC 1950); else deflated alone (RFC 1951)
};

/// Inflates compressed bytes of a file, from first to last, by 64 KiB at a time.
class Inflater {
 public:
  /// `place` and `mend` are those of its errors. `file` must outlive it.
  Inflater(const InputFile& file, const DeflatedData& data, std::string place, const char* mend);
  ~Inflater();
  Inflater(Inflater&& other) noexcept;
  Inflater& operator=(Inflater&&) = delete;

  /// Fills `bytes` and returns how many of them there are. Throws Error if the data are damaged, or
  /// is_interrupted() becomes true.
  std::size_t read(std::span<std::byte> bytes);

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield
