#include "io/plain/zip.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "io/plain/inflater.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr const char* kDamagedArchive = "the archive is damaged or truncated; use another copy";
constexpr std::uint64_t kMostDirectoryBytes = 16U << 20U;
constexpr std::uint32_t kIn64Bits = 0xffffffff;

[[noreturn]] void fail_archive(const InputFile& archive, std::string_view failure) {
  throw Error(archive.path().string(), failure, kDamagedArchive);
}

/// Little-endian numbers of a record of the archive.
class ZipRecord {
 public:
  ZipRecord(const InputFile& archive, std::string_view bytes) : archive_(archive), bytes_(bytes) {}

  [[nodiscard]] std::uint64_t number(std::size_t at, std::size_t size) const {
    if (at + size > bytes_.size()) fail_archive(archive_, "a record of the archive is cut off");
    std::uint64_t value = 0;
    for (std::size_t i = size; i-- > 0;) {
      value = value << 8U | static_cast<unsigned char>(bytes_[at + i]);
    }
    return value;
  }
  [[nodiscard]] std::string_view text(std::size_t at, std::size_t size) const {
    if (at + size > bytes_.size()) fail_archive(archive_, "a record of the archive is cut off");
    return bytes_.substr(at, size);
  }

 private:
  const InputFile& archive_;
  std::string_view bytes_;
};

struct Directory {
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;
};

/// Reads the end of central directory record, and that of 64 bits where it is needed.
Directory find_directory(const InputFile& archive) {
  constexpr std::uint64_t kEndBytes = 22;
  constexpr std::uint64_t kLongestComment = 65535;
  constexpr std::uint64_t kLocatorBytes = 20;
  const std::uint64_t searched = std::min(archive.size(), kEndBytes + kLongestComment);
  const std::uint64_t first = archive.size() - searched;
  const std::string tail = archive.text_at(first, searched);
  const std::size_t at = tail.rfind("PK\5\6");
  if (at == std::string::npos) fail_archive(archive, "has no directory of its members");
  const ZipRecord end(archive, std::string_view(tail).substr(at));
  if (first + at + kEndBytes + end.number(20, 2) > archive.size()) {
    fail_archive(archive, "ends within its last record");
  }
  Directory directory = {end.number(16, 4), end.number(12, 4)};
  if (directory.offset == kIn64Bits || directory.bytes == kIn64Bits) {
    const std::uint64_t end_at = first + at;
    if (end_at < kLocatorBytes) fail_archive(archive, "has no directory of its members");
    const std::string locator_text = archive.text_at(end_at - kLocatorBytes, kLocatorBytes);
    const ZipRecord locator(archive, locator_text);
    if (locator.text(0, 4) != "PK\6\7") fail_archive(archive, "has no directory of its members");
    const std::string end_text = archive.text_at(locator.number(8, 8), 56);
    const ZipRecord end_64(archive, end_text);
    if (end_64.text(0, 4) != "PK\6\6") fail_archive(archive, "has no directory of its members");
    directory = {end_64.number(48, 8), end_64.number(40, 8)};
  }
  if (directory.bytes > kMostDirectoryBytes || directory.offset > archive.size() ||
      directory.bytes > archive.size() - directory.offset) {
    fail_archive(archive, "its directory lies outside the file");
  }
  return directory;
}

/// Replaces sizes and offset that do not fit into 32 bits by those of the extra field 1.
void take_64_bits(const ZipRecord& extra, std::size_t extra_bytes,
                  const std::array<std::uint64_t*, 3>& values) {
  for (std::size_t at = 0; at + 4 <= extra_bytes;) {
    const std::uint64_t id = extra.number(at, 2);
    const std::uint64_t size = extra.number(at + 2, 2);
    at += 4;
    if (id == 1) {
      std::size_t next = at;
      for (std::uint64_t* const value : values) {
        if (*value != kIn64Bits) continue;
        *value = extra.number(next, 8);
        next += 8;
      }
      return;
    }
    at += size;
  }
}

/// Sets the offset of a member's data, which follow its local header.
void find_data(const InputFile& archive, std::uint64_t header_at, ZipMember& member) {
  constexpr std::uint64_t kHeaderBytes = 30;
  const std::string text = archive.text_at(header_at, kHeaderBytes);
  const ZipRecord header(archive, text);
  if (header.text(0, 4) != "PK\3\4") {
    fail_archive(archive, fmt::format("has no member at byte {}", header_at));
  }
  member.data = header_at + kHeaderBytes + header.number(26, 2) + header.number(28, 2);
  if (member.data > archive.size() || member.stored_bytes > archive.size() - member.data) {
    fail_archive(archive, fmt::format("ends within its member '{:.60}'", member.name));
  }
}

void check_member(const InputFile& archive, const ZipMember& member, std::uint64_t flags,
                  std::uint64_t method) {
  constexpr std::uint64_t kEncrypted = 1;
  const std::string place = fmt::format("{}: {:.60}", archive.path().string(), member.name);
  if ((flags & kEncrypted) != 0) throw Error(place, "is encrypted", "save it without a password");
  if (method != 0 && method != 8) {
    throw Error(place, fmt::format("is compressed by method {}", method),
                "use numpy.savez or numpy.savez_compressed");
  }
  if (!member.is_deflated && member.bytes != member.stored_bytes) {
    throw Error(place, "has two different sizes", kDamagedArchive);
  }
}

Inflater inflater_of(const InputFile& archive, const ZipMember& member) {
  return {archive,
          {.at = member.data, .bytes = member.stored_bytes},
          fmt::format("{}: {:.60}", archive.path().string(), member.name),
          kDamagedArchive};
}

}  // namespace

std::vector<ZipMember> list_zip(const InputFile& archive) {
  constexpr std::size_t kEntryBytes = 46;
  const Directory directory = find_directory(archive);
  const std::string text = archive.text_at(directory.offset, directory.bytes);
  std::vector<ZipMember> members;
  for (std::size_t at = 0; at + kEntryBytes <= text.size();) {
    const ZipRecord entry(archive, std::string_view(text).substr(at));
    if (entry.text(0, 4) != "PK\1\2") fail_archive(archive, "its directory is damaged");
    const std::size_t name_bytes = entry.number(28, 2);
    const std::size_t extra_bytes = entry.number(30, 2);
    ZipMember member;
    member.name = entry.text(kEntryBytes, name_bytes);
    member.checksum = static_cast<std::uint32_t>(entry.number(16, 4));
    member.stored_bytes = entry.number(20, 4);
    member.bytes = entry.number(24, 4);
    std::uint64_t header_at = entry.number(42, 4);
    const std::uint64_t method = entry.number(10, 2);
    member.is_deflated = method == 8;
    take_64_bits({archive, entry.text(kEntryBytes + name_bytes, extra_bytes)}, extra_bytes,
                 {&member.bytes, &member.stored_bytes, &header_at});
    check_member(archive, member, entry.number(8, 2), method);
    find_data(archive, header_at, member);
    members.push_back(std::move(member));
    at += kEntryBytes + name_bytes + extra_bytes + entry.number(32, 2);
  }
  return members;
}

std::string head_of(const InputFile& archive, const ZipMember& member, std::size_t count) {
  if (!member.is_deflated) {
    return archive.text_at(member.data, std::min<std::uint64_t>(count, member.bytes));
  }
  std::string head(static_cast<std::size_t>(std::min<std::uint64_t>(count, member.bytes)), '\0');
  head.resize(inflater_of(archive, member).read(std::as_writable_bytes(std::span(head))));
  return head;
}

std::vector<std::byte> inflate(const InputFile& archive, const ZipMember& member) {
  const std::string place = fmt::format("{}: {:.60}", archive.path().string(), member.name);
  if (const std::uint64_t most = most_inflated(member.stored_bytes); member.bytes > most) {
    throw Error(place,
                fmt::format("has {} bytes in {}, and at most {} are read of so few", member.bytes,
                            member.stored_bytes, most),
                "save it uncompressed, with numpy.savez");
  }
  if (member.bytes / kMostDeflateRatio > member.stored_bytes) {
    throw Error(place, "is smaller than any compression makes it", kDamagedArchive);
  }
  // One byte more, so that too long a member is noticed.
  std::vector<std::byte> bytes(member.bytes + 1);
  const std::size_t found = inflater_of(archive, member).read(bytes);
  bytes.resize(member.bytes);
  uLong checksum = crc32(0, nullptr, 0);
  checksum = crc32_z(checksum, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  if (found != member.bytes || checksum != member.checksum) {
    throw Error(place, "differs from its size or checksum", kDamagedArchive);
  }
  return bytes;
}

}  // namespace pillarfield
