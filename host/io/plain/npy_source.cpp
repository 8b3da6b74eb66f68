// Frames of NumPy: .npy files and .npz archives.

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/input_file.h"
#include "base/npy.h"
#include "io/frame_source.h"
#include "io/plain/array_names.h"
#include "io/plain/inflater.h"
#include "io/plain/source.h"
#include "io/plain/zip.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr std::size_t kMostMembers = 1000;

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
  std::string name;  ///< of the member, without .npy
  ZipMember member;
  NpyHeader header;
};

/// The arrays of numbers in an archive; others, such as text, are left out.
class NpzArchive {
 public:
  explicit NpzArchive(const std::filesystem::path& path) : path_(path), file_(path), names_(path) {
    const std::vector<ZipMember> members = list_zip(file_);
    if (members.size() > kMostMembers) {
      throw Error(path_.string(), fmt::format("has {} members", members.size()),
                  fmt::format("archives of at most {} arrays are read", kMostMembers));
    }
    for (const ZipMember& member : members) add(member);
  }

  [[nodiscard]] const ArrayNames& names() const { return names_; }
  /// Throws Error if it is not an archive of NumPy.
  void require_arrays() const {
    if (!has_npy_) refuse_foreign_archive(path_, is_workbook_);
  }

  [[nodiscard]] std::unique_ptr<NumberArray> open(std::size_t index) const {
    const NpzArray& array = arrays_[index];
    std::string place = fmt::format("{}: {}", path_.string(), array.name);
    if (!array.member.is_deflated) {
      return npy_in_file(InputFile(path_), array.member.data, array.member.bytes, std::move(place));
    }
    std::vector<std::byte> bytes = inflate(file_, array.member);
    const NpyHeader& header = array.header;
    if (bytes.size() - header.bytes < header.data_bytes) {
      throw Error(place, "is shorter than its header says", "use another copy");
    }
    bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(header.bytes));
    if (header.is_swapped) {
      swap_bytes(bytes.data(), header.data_bytes / header.type.bytes, header.type.bytes);
    }
    return array_in_memory(std::move(place), header.type, header.shape, std::move(bytes));
  }

 private:
  void add(const ZipMember& member) {
    constexpr std::string_view kEnding = ".npy";
    std::string name = member.name;
    if (name.ends_with(kEnding)) name.resize(name.size() - kEnding.size());
    const std::string head = head_of(file_, member, kLongestNpyHeader);
    is_workbook_ = is_workbook_ || name == "xl/workbook.xml";
    if (!head.starts_with(kNpyMagic)) return;
    has_npy_ = true;
    try {
      arrays_.push_back({name, member, header_of_readings(head, name)});
      names_.add(name, arrays_.back().header.shape.size());
    } catch (const Error& error) {
      names_.refuse(name, error.what());
    }
  }

  std::filesystem::path path_;
  InputFile file_;
  std::vector<NpzArray> arrays_;
  bool has_npy_ = false;
  bool is_workbook_ = false;
  ArrayNames names_;
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
  std::unique_ptr<NumberArray> readings =
      archive.open(archive.names().array_of_frames(options.dataset));
  std::vector<double> times_s;
  const auto times = archive.names().array_of_times(options.times);
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
