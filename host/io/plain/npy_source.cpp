// Frames of NumPy: .npy files and .npz archives.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <utility>

#include "base/input_file.h"
#include "base/npy.h"
#include "io/frame_source.h"
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

class NpyInFile final : public NumberArray {
 public:
  NpyInFile(InputFile file, std::uint64_t data, const NpyHeader& header, std::string place)
      : NumberArray(std::move(place), header.type, header.shape),
        file_(std::move(file)),
        data_(data),
        is_swapped_(header.is_swapped) {}

  void read(std::uint64_t first, std::uint64_t count, std::byte* numbers) override {
    const std::size_t bytes = count * slice_bytes();
    file_.read(data_ + first * slice_bytes(), {numbers, bytes});
    if (is_swapped_) swap_bytes(numbers, bytes / type().bytes, type().bytes);
  }

 private:
  InputFile file_;
  std::uint64_t data_;
  bool is_swapped_;
};

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
  return std::make_unique<NpyInFile>(std::move(file), offset + header.bytes, header,
                                     std::move(place));
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
  explicit NpzArchive(const std::filesystem::path& path) : path_(path), file_(path) {
    const std::vector<ZipMember> members = list_zip(file_);
    if (members.size() > kMostMembers) {
      throw Error(path_.string(), fmt::format("has {} members", members.size()),
                  fmt::format("archives of at most {} arrays are read", kMostMembers));
    }
    for (const ZipMember& member : members) add(member);
  }

  [[nodiscard]] const NpzArray* find(const std::string& name) const {
    const auto found = std::ranges::find(arrays_, name, &NpzArray::name);
    return found == arrays_.end() ? nullptr : &*found;
  }

  /// The named array, or the only one of three dimensions, or of two if none has three.
  [[nodiscard]] const NpzArray& array_of_frames(const std::string& name) const {
    if (!name.empty()) return require(name);
    for (const std::size_t dimensions : {3U, 2U}) {
      std::vector<const NpzArray*> found;
      std::vector<std::string> names;
      for (const NpzArray& array : arrays_) {
        if (array.header.shape.size() != dimensions) continue;
        found.push_back(&array);
        names.push_back(array.name);
      }
      if (found.size() == 1) return *found.front();
      if (found.size() < 2) continue;
      throw Error(path_.string(), fmt::format("holds several arrays: {}", fmt::join(names, ", ")),
                  "choose the readings with --dataset NAME");
    }
    throw Error(path_.string(), "holds no array of frames",
                "save an array of the shape (frames, rows, columns)");
  }

  [[nodiscard]] const NpzArray& require(const std::string& name) const {
    if (const NpzArray* const array = find(name)) return *array;
    if (const auto found = refused_.find(name); found != refused_.end()) {
      throw Error(fmt::format("{}: {}", path_.string(), name), found->second);
    }
    std::vector<std::string> names;
    for (const NpzArray& array : arrays_) names.push_back(array.name);
    throw Error(path_.string(), fmt::format("has no array '{:.60}'", name),
                names.empty() ? "it has no array of numbers"
                              : fmt::format("it has {}", fmt::join(names, ", ")));
  }

  [[nodiscard]] std::unique_ptr<NumberArray> open(const NpzArray& array) const {
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
    if (!head.starts_with(kNpyMagic)) return;
    try {
      arrays_.push_back({name, member, header_of_readings(head, name)});
    } catch (const Error& error) {
      refused_.emplace(name, error.what());
    }
  }

  std::filesystem::path path_;
  InputFile file_;
  std::vector<NpzArray> arrays_;
  std::map<std::string, std::string> refused_;  ///< name, and why
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
  constexpr const char* kTimes = "time";
  const NpzArchive archive(path);
  std::unique_ptr<NumberArray> readings = archive.open(archive.array_of_frames(options.dataset));
  std::vector<double> times_s;
  const NpzArray* const times =
      options.times.empty() ? archive.find(kTimes) : &archive.require(options.times);
  if (times != nullptr) times_s = read_numbers(*archive.open(*times));
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
