#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/input_file.h"

namespace pillarfield {

/// A file within a ZIP archive.
struct ZipMember {
  std::string name;
  bool is_deflated = false;        ///< else stored
  std::uint64_t stored_bytes = 0;  ///< in the archive
  std::uint64_t bytes = 0;         ///< uncompressed
  std::uint32_t checksum = 0;      ///< CRC-32 of the uncompressed bytes
  std::uint64_t data = 0;          ///< offset in the archive
};

/// Lists the stored and deflated members of a ZIP archive (APPNOTE.TXT of PKWARE, version 6.3), in
/// 64-bit form too. Throws Error if it is damaged, encrypted, or a member lies outside the file.
[[nodiscard]] std::vector<ZipMember> list_zip(const InputFile& archive);

/// The first bytes of a member, at most `count`.
[[nodiscard]] std::string head_of(const InputFile& archive, const ZipMember& member,
                                  std::size_t count);

/// Inflates a deflated member. Throws Error if it exceeds most_inflated(), has another size than
/// the archive says, or another checksum.
[[nodiscard]] std::vector<std::byte> inflate(const InputFile& archive, const ZipMember& member);

}  // namespace pillarfield
