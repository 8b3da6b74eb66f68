#include "io/hdf5/filters.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <memory>

#include "pillarfield/error.h"

namespace pillarfield::hdf5 {
namespace {

constexpr std::size_t kChecksumBytes = 4;

bool is_known(H5Z_filter_t filter) {
  return filter == H5Z_FILTER_DEFLATE || filter == H5Z_FILTER_SHUFFLE ||
         filter == H5Z_FILTER_FLETCHER32;
}

/// Reduces a sum modulo 65535 as repeated addition of its halves does: a nonzero multiple of 65535
/// becomes 65535.
std::uint32_t folded(std::uint64_t sum) {
  return sum == 0 ? 0 : static_cast<std::uint32_t>((sum - 1) % 65535 + 1);
}

/// Fletcher's checksum of big-endian 16-bit words, the last one padded with a zero byte.
std::uint32_t fletcher32(const std::byte* bytes, std::size_t count) {
  constexpr std::size_t kWordsBeforeOverflow = 1 << 20;  // `second` has 64 bits
  std::uint64_t first = 0;
  std::uint64_t second = 0;
  std::size_t words = 0;
  for (std::size_t i = 0; i < count; i += 2) {
    const auto high = std::to_integer<std::uint32_t>(bytes[i]) << 8;
    const auto low = i + 1 < count ? std::to_integer<std::uint32_t>(bytes[i + 1]) : 0;
    first += high | low;
    second += first;
    if (++words % kWordsBeforeOverflow != 0) continue;
    first = folded(first);
    second = folded(second);
  }
  return folded(second) << 16 | folded(first);
}

}  // namespace

Filters::Filters(const std::filesystem::path& file, const std::string& name,
                 const Handle& creation_list, std::size_t value_bytes)
    : file_(file), name_(name), value_bytes_(value_bytes) {
  const int count = H5Pget_nfilters(creation_list.get());
  require(count, file, fmt::format("the filters of {} cannot be read", name), kDamaged);
  for (int index = 0; index < count; ++index) {
    unsigned flags = 0;
    std::size_t values = 0;
    char filter_name[64] = "";
    const H5Z_filter_t filter =
        H5Pget_filter2(creation_list.get(), static_cast<unsigned>(index), &flags, &values, nullptr,
                       sizeof filter_name, filter_name, nullptr);
    if (!is_known(filter) || std::ranges::find(ids_, filter) != ids_.end()) {
      throw Error(file.string(),
                  fmt::format("{} is stored with '{:.60}', HDF5 filter {}, which is not supported",
                              name, filter_name, filter),
                  "store it with gzip, shuffle and fletcher32, each at most once, or uncompressed");
    }
    ids_.push_back(filter);
  }
}

void Filters::fail_on_chunk(const std::string& what) const {
  throw Error(file_.string(), fmt::format("a chunk of {} {}", name_, what), kDamaged);
}

std::vector<std::byte> Filters::undo(std::vector<std::byte> stored, std::uint32_t skipped,
                                     std::size_t chunk_bytes) const {
  std::vector<std::byte> bytes = std::move(stored);
  const auto applied = [&](std::size_t index) { return (skipped >> index & 1U) == 0; };
  for (std::size_t index = ids_.size(); index-- > 0;) {
    if (!applied(index)) continue;
    if (ids_[index] == H5Z_FILTER_FLETCHER32) {
      take_checksum(bytes);
    } else if (ids_[index] == H5Z_FILTER_SHUFFLE) {
      bytes = unshuffled(bytes);
    } else {
      std::size_t before = chunk_bytes;
      for (std::size_t i = 0; i < index; ++i) {
        if (ids_[i] == H5Z_FILTER_FLETCHER32 && applied(i)) before += kChecksumBytes;
      }
      bytes = inflated(bytes, before);
    }
  }
  if (bytes.size() == chunk_bytes) return bytes;
  fail_on_chunk(fmt::format("holds {} bytes instead of {}", bytes.size(), chunk_bytes));
}

std::vector<std::byte> Filters::inflated(const std::vector<std::byte>& stored,
                                         std::size_t bytes) const {
  std::vector<std::byte> out(bytes);
  z_stream stream = {};
  if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
  const std::unique_ptr<z_stream, int (*)(z_stream*)> ended(&stream, inflateEnd);
  // zlib accepts pointers to constant bytes only with ZLIB_CONST.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(stored.data()));
  stream.avail_in = static_cast<uInt>(stored.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int result = inflate(&stream, Z_FINISH);
  if (result == Z_STREAM_END && stream.avail_out == 0) return out;
  if (result == Z_STREAM_END || result == Z_OK || result == Z_BUF_ERROR) {
    const bool longer = stream.avail_out == 0;
    fail_on_chunk(fmt::format("inflates to {} bytes instead of {}",
                              longer ? "more" : std::to_string(stream.total_out), bytes));
  }
  fail_on_chunk("cannot be inflated");
}

/// Undoes shuffle, which stores the first bytes of all values, then the second bytes, and so on;
/// bytes beyond the last whole value stay at the end.
std::vector<std::byte> Filters::unshuffled(const std::vector<std::byte>& stored) const {
  std::vector<std::byte> out(stored);
  const std::size_t values = stored.size() / value_bytes_;
  for (std::size_t byte = 0; byte < value_bytes_; ++byte) {
    const std::byte* const plane = stored.data() + byte * values;
    for (std::size_t value = 0; value < values; ++value) {
      out[value * value_bytes_ + byte] = plane[value];
    }
  }
  return out;
}

void Filters::take_checksum(std::vector<std::byte>& stored) const {
  if (stored.size() < kChecksumBytes) fail_on_chunk("is too short for its checksum");
  const std::size_t bytes = stored.size() - kChecksumBytes;
  std::uint32_t kept = 0;
  for (std::size_t i = kChecksumBytes; i-- > 0;) {
    kept = kept << 8 | std::to_integer<std::uint32_t>(stored[bytes + i]);
  }
  if (fletcher32(stored.data(), bytes) != kept) fail_on_chunk("does not match its checksum");
  stored.resize(bytes);
}

}  // namespace pillarfield::hdf5
