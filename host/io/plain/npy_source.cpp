// Frames of NumPy: .npy files and .npz archives.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <minizip/unzip.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "base/input_file.h"
#include "base/npy.h"
#include "io/frame_source.h"
#include "io/plain/source.h"
#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"

namespace pillarfield {
namespace {

constexpr std::size_t kMostMembers = 1000;
constexpr std::size_t kMostAtOnce = std::size_t{16} << 20U;  // bytes

/// Most bytes that a deflated member is inflated to: 64 times as many as it has, but always
/// 256 MiB, and never more than 1 GiB.
constexpr std::uint64_t most_inflated(std::uint64_t stored_bytes) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 30U;
  return std::clamp(64 * std::min(stored_bytes, kMost), kMost / 4, kMost);
}
constexpr const char* kDamagedArchive = "the archive is damaged or truncated; use another copy";

/// The header of an array of readings. Throws Error if it is damaged, or the array has booleans or
/// Fortran order.
NpyHeader header_of_readings(std::string_view head, const std::string& place) {
  NpyHeader header = parse_npy_header(head, place);
  if (header.is_boolean) {
    throw Error(place, "holds bool, which is not a type of readings",
                "store integers, float32 or float64");
  }
  if (header.by_columns) {
    throw Error(place, "is stored in Fortran order", "save numpy.ascontiguousarray(array)");
  }
  return header;
}

/// The array at `offset` of a file, whose data are read when they are asked for. Throws Error if
/// the file is shorter than the header says; `available` is the largest size, header included.
std::unique_ptr<NumberArray> npy_in_file(InputFile file, std::uint64_t offset,
                                         std::uint64_t available, std::string place) {
  const NpyHeader header = header_of_readings(
      file.text_at(offset, std::min<std::uint64_t>(available, kLongestNpyHeader)), place);
  if (header.data_bytes > available - header.bytes) {
    throw Error(place,
                fmt::format("claims {} {}, more than its {} bytes hold",
                            text_of_shape(header.shape), name_of(header.type), available),
                "the file is damaged or truncated; use another copy");
  }
  return array_in_file(std::move(file), offset + header.bytes, header.is_swapped, std::move(place),
                       header.type, header.shape);
}

/// An array of an archive.
struct NpzArray {
  std::string name;       ///< of the member, without .npy
  unz64_file_pos place;   ///< of its entry in the directory
  unz_file_info64 info;   ///< its sizes
  std::uint64_t data_at;  ///< offset in the archive
  NpyHeader header;
};

/// The arrays of numbers in an archive of stored or deflated members; others, such as text, are
/// left out.
class NpzArchive {
 public:
  explicit NpzArchive(const std::filesystem::path& path)
      : file_(path),
        zip_(unzOpen64(fmt::format("/proc/self/fd/{}", file_.descriptor()).c_str()), unzClose) {
    if (!zip_) fail_archive("has no directory of its members");
    std::size_t members = 0;
    int result = unzGoToFirstFile(zip_.get());
    for (; result == UNZ_OK; result = unzGoToNextFile(zip_.get())) {
      if (++members > kMostMembers) {
        throw Error(path.string(), fmt::format("has more than {} members", kMostMembers),
                    "save the frames alone");
      }
      add_member();
    }
    if (result != UNZ_END_OF_LIST_OF_FILE) fail_archive("its directory is damaged");
  }

  /// The named array, or the only one of three dimensions or more, or of two if none has three.
  /// Throws Error, naming the arrays, if there is no such array.
  [[nodiscard]] std::size_t array_of_frames(const std::string& name) const {
    if (!name.empty()) return require(name);
    for (const bool is_deep : {true, false}) {
      std::vector<std::string> names;
      std::size_t found = 0;
      for (std::size_t index = 0; index < arrays_.size(); ++index) {
        const std::size_t dimensions = arrays_[index].header.shape.size();
        if (is_deep ? dimensions < 3 : dimensions != 2) continue;
        found = index;
        names.push_back(arrays_[index].name);
      }
      if (names.size() == 1) return found;
      if (names.empty()) continue;
      throw Error(file_.path().string(), fmt::format("holds several arrays: {}", list_of(names)),
                  "choose the readings with --dataset NAME");
    }
    std::vector<std::string> reasons;
    for (const auto& [refused, why] : refused_) reasons.push_back(why);
    throw Error(
        file_.path().string(),
        fmt::format("holds no array of frames{}{}", reasons.empty() ? "" : ": ", list_of(reasons)),
        "save an array of the shape (frames, rows, columns)");
  }

  /// The named array, or `time` if the name is empty; unset if there is no `time`.
  [[nodiscard]] std::optional<std::size_t> array_of_times(const std::string& name) const {
    return name.empty() ? find("time") : require(name);
  }
  /// Throws Error if it is not an archive of NumPy.
  void require_arrays() const {
    if (!has_npy_) refuse_foreign_archive(file_.path(), is_workbook_);
  }

  /// Throws Error if the array exceeds most_inflated(), or has another size or checksum than the
  /// archive says.
  [[nodiscard]] std::unique_ptr<NumberArray> open(std::size_t index) const {
    const NpzArray& array = arrays_[index];
    const std::string place = place_of(array.name);
    if (array.info.compression_method == 0) {
      verify(array);
      return npy_in_file(InputFile(file_.path()), array.data_at, array.info.uncompressed_size,
                         place);
    }
    std::vector<std::byte> bytes = inflated(array);
    const NpyHeader& header = array.header;
    if (bytes.size() - header.bytes < header.data_bytes) {
      throw Error(place, "is shorter than its header says", "use another copy");
    }
    bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(header.bytes));
    if (header.is_swapped) {
      swap_bytes(bytes.data(), header.data_bytes / header.type.bytes, header.type.bytes);
    }
    return array_in_memory(place, header.type, header.shape, std::move(bytes));
  }

 private:
  /// "a, b, c"; of many names the first ones.
  static std::string list_of(std::vector<std::string> names) {
    constexpr std::size_t kMostNames = 20;
    const bool is_long = names.size() > kMostNames;
    if (is_long) names.resize(kMostNames);
    return fmt::format("{}{}", fmt::join(names, ", "), is_long ? ", ..." : "");
  }

  [[nodiscard]] std::optional<std::size_t> find(const std::string& name) const {
    const auto found = std::ranges::find(arrays_, name, &NpzArray::name);
    if (found == arrays_.end()) return std::nullopt;
    return static_cast<std::size_t>(found - arrays_.begin());
  }

  [[nodiscard]] std::size_t require(const std::string& name) const {
    if (const auto found = find(name)) return *found;
    const std::string path = file_.path().string();
    if (const auto found = refused_.find(name); found != refused_.end())
      throw Error(path, found->second);
    std::vector<std::string> names;
    for (const NpzArray& array : arrays_) names.push_back(array.name);
    throw Error(
        path, fmt::format("has no array '{:.60}'", name),
        names.empty() ? "it has no array of numbers" : fmt::format("it has {}", list_of(names)));
  }

  [[noreturn]] void fail_archive(const char* failure) const {
    throw Error(file_.path().string(), failure, kDamagedArchive);
  }

  [[nodiscard]] std::string place_of(const std::string& name) const {
    return fmt::format("{}: {:.60}", file_.path().string(), name);
  }

  /// Takes the member at the current entry of the directory, if it is an array.
  void add_member() {
    constexpr std::string_view kEnding = ".npy";
    std::array<char, 1024> text{};
    NpzArray array = {};
    unz_file_info64& info = array.info;
    if (unzGetCurrentFileInfo64(zip_.get(), &info, text.data(), text.size() - 1, nullptr, 0,
                                nullptr, 0) != UNZ_OK ||
        unzGetFilePos64(zip_.get(), &array.place) != UNZ_OK) {
      fail_archive("its directory is damaged");
    }
    array.name = text.data();
    check_method(array);
    if (array.name.ends_with(kEnding)) array.name.resize(array.name.size() - kEnding.size());
    open_member(array);
    array.data_at = unzGetCurrentFileZStreamPos64(zip_.get());
    if (array.data_at > file_.size() || info.compressed_size > file_.size() - array.data_at) {
      fail_archive("ends within a member");
    }
    require_name_at_member(array, text.data());
    std::string head(std::min<std::uint64_t>(kLongestNpyHeader, info.uncompressed_size), '\0');
    head.resize(read_member(std::as_writable_bytes(std::span(head)), place_of(array.name)));
    is_workbook_ = is_workbook_ || array.name == "xl/workbook.xml";
    if (!head.starts_with(kNpyMagic)) return;
    has_npy_ = true;
    try {
      array.header = header_of_readings(head, array.name);
      arrays_.push_back(std::move(array));
    } catch (const Error& error) {
      refused_.emplace(array.name, error.what());
    }
  }

  void check_method(const NpzArray& array) const {
    constexpr unsigned kEncrypted = 1;
    const auto& [name, place, info, data_at, header] = array;
    if ((info.flag & kEncrypted) != 0) {
      throw Error(place_of(name), "is encrypted", "save it without a password");
    }
    if (info.compression_method != 0 && info.compression_method != Z_DEFLATED) {
      throw Error(place_of(name),
                  fmt::format("is compressed by method {}", info.compression_method),
                  "use numpy.savez or numpy.savez_compressed");
    }
    if (info.compression_method == 0 && info.uncompressed_size != info.compressed_size) {
      throw Error(place_of(name), "has two different sizes", kDamagedArchive);
    }
  }

  void open_member(const NpzArray& array) const {
    if (unzGoToFilePos64(zip_.get(), &array.place) == UNZ_OK &&
        unzOpenCurrentFile(zip_.get()) == UNZ_OK) {
      return;
    }
    throw Error(place_of(array.name), "is not where the archive says", kDamagedArchive);
  }

  /// Reads from the open member; returns the number of bytes, fewer at its end.
  std::size_t read_member(std::span<std::byte> bytes, const std::string& place) const {
    std::size_t found = 0;
    while (found < bytes.size()) {
      if (is_interrupted()) throw Error(place, "interrupted while it was read", "start again");
      const std::size_t count = std::min(bytes.size() - found, kMostAtOnce);
      const int read = unzReadCurrentFile(zip_.get(), &bytes[found], static_cast<unsigned>(count));
      if (read < 0) throw Error(place, "cannot be decompressed", kDamagedArchive);
      if (read == 0) break;
      found += static_cast<std::size_t>(read);
    }
    return found;
  }

  /// Throws Error if the directory has another name for the member than the member itself: then one
  /// of them is damaged, and may name readings of others.
  void require_name_at_member(const NpzArray& array, const std::string& name) const {
    const int extra_bytes = unzGetLocalExtrafield(zip_.get(), nullptr, 0);
    const std::uint64_t bytes = name.size() + static_cast<std::uint64_t>(std::max(extra_bytes, 0));
    if (bytes <= array.data_at && file_.text_at(array.data_at - bytes, name.size()) == name) return;
    throw Error(place_of(array.name), "has two different names", kDamagedArchive);
  }

  /// Throws Error if the stored member differs from its checksum.
  void verify(const NpzArray& array) const {
    open_member(array);
    std::vector<std::byte> part(std::min<std::uint64_t>(array.info.uncompressed_size, kMostAtOnce));
    while (read_member(part, place_of(array.name)) == part.size() && !part.empty()) continue;
    require_checksum(array);
  }

  /// Throws Error if the open member, read to its end, differs from its checksum.
  void require_checksum(const NpzArray& array) const {
    if (unzCloseCurrentFile(zip_.get()) == UNZ_OK) return;
    throw Error(place_of(array.name), "differs from its checksum", kDamagedArchive);
  }

  [[nodiscard]] std::vector<std::byte> inflated(const NpzArray& array) const {
    constexpr std::uint64_t kMostDeflateRatio = 1032;
    const std::string place = place_of(array.name);
    const std::uint64_t size = array.info.uncompressed_size;
    const std::uint64_t stored = array.info.compressed_size;
    if (const std::uint64_t most = most_inflated(stored); size > most) {
      throw Error(
          place,
          fmt::format("has {} bytes in {}, and at most {} are read of so few", size, stored, most),
          "save it uncompressed, with numpy.savez");
    }
    if (size / kMostDeflateRatio > stored) {
      throw Error(place, "is smaller than any compression makes it", kDamagedArchive);
    }
    open_member(array);
    std::vector<std::byte> bytes(size);
    if (read_member(bytes, place) != size) {
      throw Error(place, "differs from its size", kDamagedArchive);
    }
    require_checksum(array);
    return bytes;
  }

  InputFile file_;
  std::unique_ptr<void, int (*)(unzFile)> zip_;
  std::vector<NpzArray> arrays_;
  bool has_npy_ = false;
  bool is_workbook_ = false;
  std::map<std::string, std::string> refused_;  // name, and why
};

std::unique_ptr<FileSource> open_npy(const std::filesystem::path& path,
                                     const ReadOptions& options) {
  refuse_dataset(path, options);
  InputFile file(path);
  const std::uint64_t size = file.size();
  return array_source(path, "NumPy array", npy_in_file(std::move(file), 0, size, path.string()), {},
                      options);
}

std::unique_ptr<FileSource> open_npz(const std::filesystem::path& path,
                                     const ReadOptions& options) {
  const NpzArchive archive(path);
  archive.require_arrays();
  std::unique_ptr<NumberArray> readings = archive.open(archive.array_of_frames(options.dataset));
  std::vector<double> times_s;
  const auto times = archive.array_of_times(options.times);
  if (times) times_s = read_numbers(*archive.open(*times));
  return array_source(path, "NumPy archive", std::move(readings), std::move(times_s), options);
}

}  // namespace

SourceFormat npy_format() {
  return {.name = "NumPy array (.npy)",
          .recognises = [](std::string_view head) { return head.starts_with(kNpyMagic); },
          .open = open_npy};
}

SourceFormat npz_format() {
  return {.name = "NumPy archive (.npz)",
          .recognises =
              [](std::string_view head) {
                return head.starts_with("PK\3\4") || head.starts_with("PK\5\6");
              },
          .open = open_npz};
}

}  // namespace pillarfield
