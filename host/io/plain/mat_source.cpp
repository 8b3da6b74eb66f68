// Frames of MATLAB: .mat files of version 5, as save -v6 and -v7, Octave and SciPy write them
// ("MAT-File Format", The MathWorks). Those of version 7.3 are HDF5.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include "base/input_file.h"
#include "io/frame_source.h"
#include "io/plain/array_names.h"
#include "io/plain/inflater.h"
#include "io/plain/source.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr std::size_t kMatHeaderBytes = 128;
constexpr std::uint64_t kMatTagBytes = 8;
constexpr std::size_t kMostVariables = 1000;  // cells and fields of structs included
constexpr const char* kDamagedMat = "the file is damaged or truncated; use another copy";

/// Types of the elements of a MAT-file that are no numbers, miINT8 to miCOMPRESSED.
enum class MatType : std::uint32_t {
  int8 = 1,
  int32 = 5,
  uint32 = 6,
  matrix = 14,
  compressed = 15
};

/// Classes of MATLAB's values, mxCELL_CLASS to mxOPAQUE_CLASS.
enum class MatClass : std::uint8_t {
  cell = 1,
  structure = 2,
  text = 4,
  sparse = 5,
  first_number = 6,
  last_number = 15,
  opaque = 17
};

/// Type of numbers by their MatType, miINT8 to miUINT64; without bytes: none.
NumberType number_type_of(MatType type) {
  using enum NumberType::Kind;
  constexpr NumberType kNone = {real, 0};
  constexpr std::array kTypes = {kNone,
                                 NumberType{signed_integer, 1},
                                 NumberType{unsigned_integer, 1},
                                 NumberType{signed_integer, 2},
                                 NumberType{unsigned_integer, 2},
                                 NumberType{signed_integer, 4},
                                 NumberType{unsigned_integer, 4},
                                 NumberType{real, 4},
                                 kNone,
                                 NumberType{real, 8},
                                 kNone,
                                 kNone,
                                 NumberType{signed_integer, 8},
                                 NumberType{unsigned_integer, 8}};
  const auto index = static_cast<std::size_t>(type);
  return index < kTypes.size() ? kTypes[index] : kNone;
}

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.substr(at, sizeof word).data(), sizeof word);
  return word;
}

/// A variable of a MAT-file: stored itself, with its tag, or zlib's compression of it.
struct MatVariable {
  std::uint64_t at = 0;
  std::uint64_t bytes = 0;
  bool is_compressed = false;
};

/// An array of real numbers in a MAT-file.
struct MatArray {
  std::string name;  ///< "raw", "pads{3}", "log.raw", "log(2).raw"
  NumberType type;   ///< as stored: MATLAB stores doubles that are small whole numbers as integers
  std::vector<std::uint64_t> shape;  ///< the first axis varies fastest; a vector has one dimension
  MatVariable variable;
  std::uint64_t at = 0;  ///< of the numbers in the variable

  [[nodiscard]] std::uint64_t bytes() const {
    std::uint64_t bytes = type.bytes;
    for (const std::uint64_t size : shape) bytes *= size;
    return bytes;
  }
};

/// The tag of an element.
struct MatTag {
  MatType type = {};
  std::uint64_t bytes = 0;
  bool is_small = false;  ///< its data, at most four bytes, are the second half of the tag
  std::string small;
};

/// Reads a variable from its first byte on, inflating it if it is compressed.
class MatReader {
 public:
  /// Inflates at most `budget` bytes, which it reduces. Both `file` and `budget` must outlive it.
  MatReader(const InputFile& file, const MatVariable& variable, std::uint64_t& budget)
      : file_(file), variable_(variable), budget_(budget) {
    if (variable.is_compressed) inflater_.emplace(file, variable.at, variable.bytes);
  }

  [[nodiscard]] std::uint64_t at() const { return at_; }  ///< bytes read and skipped

  void read(std::span<std::byte> bytes) {
    if (!inflater_) {
      if (bytes.size() > variable_.bytes - at_) fail("ends within a variable");
      file_.read(variable_.at + at_, bytes);
    } else if (inflate(bytes) != bytes.size()) {
      fail("ends within a variable");
    }
    at_ += bytes.size();
  }

  void skip_to(std::uint64_t at) {
    if (at < at_) fail("has an element that is longer than what it is part of");
    if (!inflater_ && at > variable_.bytes) fail("ends within a variable");
    while (inflater_ && at_ < at) {
      read(std::span(skipped_).first(std::min<std::uint64_t>(skipped_.size(), at - at_)));
    }
    at_ = at;
  }

  /// Inflates the rest, so that zlib verifies its checksum.
  void finish() {
    std::size_t found = skipped_.size();
    while (inflater_ && found == skipped_.size()) {
      found = inflater_->read(skipped_);
      if (found > budget_) fail("has a variable that is longer than its length");
      budget_ -= found;
    }
  }

  [[nodiscard]] MatTag tag() {
    const std::string bytes = text(kMatTagBytes);
    const std::uint32_t first = word_at(bytes, 0);
    MatTag tag = {MatType{first & 0xffffU}, first >> 16U, first >> 16U != 0, bytes.substr(4)};
    if (!tag.is_small) {
      tag.bytes = word_at(bytes, 4);
    } else if (tag.bytes > tag.small.size()) {
      fail(fmt::format("has an element of type {}", first));
    }
    return tag;
  }

  /// The data of an element of that type after its tag. Throws Error if it is of another type or
  /// longer than `most` bytes.
  [[nodiscard]] std::string data(MatType type, std::uint64_t most) {
    const MatTag found = tag();
    if (found.type != type || found.bytes > most) {
      fail(fmt::format("has an element of type {} and {} bytes where type {} is due",
                       static_cast<std::uint32_t>(found.type), found.bytes,
                       static_cast<std::uint32_t>(type)));
    }
    if (found.is_small) return found.small.substr(0, found.bytes);
    std::string bytes = text(found.bytes);
    skip_to((at_ + 7) / 8 * 8);
    return bytes;
  }

  [[noreturn]] void fail(const std::string& failure) const {
    throw Error(file_.path().string(), failure, kDamagedMat);
  }

 private:
  [[nodiscard]] std::string text(std::uint64_t count) {
    std::string bytes(count, '\0');
    read(std::as_writable_bytes(std::span(bytes)));
    return bytes;
  }

  std::size_t inflate(std::span<std::byte> bytes) {
    if (bytes.size() > budget_) {
      throw Error(
          file_.path().string(),
          fmt::format("its variables inflate to more than {} bytes", most_inflated(file_.size())),
          "save the frames alone, with -v6 or -v7.3");
    }
    budget_ -= bytes.size();
    return inflater_->read(bytes);
  }

  const InputFile& file_;
  MatVariable variable_;
  std::uint64_t& budget_;
  std::optional<Inflater> inflater_;
  std::vector<std::byte> skipped_ = std::vector<std::byte>(std::size_t{64} << 10U);
  std::uint64_t at_ = 0;
};

/// The arrays of real numbers and logicals in a MAT-file, also in cells and structs; other values
/// are named by names() and not read.
class MatFile {
 public:
  /// Throws Error if the file is damaged, or holds more than 1000 variables, or compressed cells
  /// and structs beyond most_inflated().
  explicit MatFile(const std::filesystem::path& path) : file_(path), names_(path) {
    std::uint64_t budget = most_inflated(file_.size());
    std::size_t variables = 0;
    for (std::uint64_t at = kMatHeaderBytes; at < file_.size();) {
      if (++variables > kMostVariables) {
        throw Error(path.string(), fmt::format("has more than {} variables", kMostVariables),
                    "save the frames alone");
      }
      const std::string tag = file_.text_at(at, kMatTagBytes);
      const std::uint64_t left = file_.size() - at - tag.size();
      if (tag.size() < kMatTagBytes || word_at(tag, 4) > left) {
        throw Error(path.string(), "ends within a variable", kDamagedMat);
      }
      const std::uint64_t bytes = word_at(tag, 4);
      variable_ = {at, bytes + kMatTagBytes};
      if (MatType{word_at(tag, 0)} == MatType::compressed) {
        variable_ = {at + kMatTagBytes, bytes, true};
      }
      MatReader reader(file_, variable_, budget);
      list_matrix(reader, "", true, std::numeric_limits<std::uint64_t>::max(), 0);
      at += kMatTagBytes + bytes;
    }
  }

  [[nodiscard]] const ArrayNames& names() const { return names_; }

  /// The array in C order, so with its axes reversed. Throws Error if it is compressed and damaged,
  /// or compressed and larger than most_inflated().
  [[nodiscard]] std::unique_ptr<NumberArray> open(std::size_t index) const {
    const MatArray& array = arrays_[index];
    std::string place = fmt::format("{}: {:.100}", file_.path().string(), array.name);
    std::vector<std::uint64_t> shape(array.shape.rbegin(), array.shape.rend());
    if (array.variable.is_compressed) {
      std::vector<std::byte> numbers = inflated(array, place);
      return array_in_memory(std::move(place), array.type, std::move(shape), std::move(numbers));
    }
    return array_in_file(InputFile(file_.path()), array.variable.at + array.at, false,
                         std::move(place), array.type, std::move(shape));
  }

 private:
  struct Header {
    MatClass kind = {};
    bool is_complex = false;
    std::vector<std::uint64_t> shape;
    std::uint64_t count = 1;
    std::string name;
  };

  /// Lists the matrix that begins here, and returns its end.
  std::uint64_t list_matrix(MatReader& reader, const std::string& name, bool is_whole,
                            std::uint64_t limit, int depth) {
    const MatTag tag = reader.tag();
    const std::uint64_t end = reader.at() + tag.bytes;
    if (tag.type != MatType::matrix || tag.is_small || end > limit) {
      reader.fail("has an element that is not a matrix, or is longer than what it is part of");
    }
    ++listed_;
    if (tag.bytes == 0) return end;  // an empty cell
    const Header header = read_header(reader);
    // MATLAB stores data of its own objects without a name.
    if (header.kind == MatClass::opaque || (is_whole && header.name.empty())) return end;
    list_values(reader, header, is_whole ? header.name : name, end, depth);
    return end;
  }

  static Header read_header(MatReader& reader) {
    constexpr std::uint64_t kMostAxes = 32;
    constexpr std::uint64_t kLongestName = 1000;
    constexpr std::uint64_t kMostNumbers = std::uint64_t{1} << 32U;
    const std::string flags = reader.data(MatType::uint32, 8);
    if (flags.size() != 8) reader.fail("has a variable without a class");
    Header header;
    header.kind = MatClass{static_cast<std::uint8_t>(word_at(flags, 0) & 0xffU)};
    header.is_complex = (word_at(flags, 0) & 0x800U) != 0;
    if (header.kind == MatClass::opaque) return header;
    const std::string sizes = reader.data(MatType::int32, 4 * kMostAxes);
    for (std::size_t at = 0; at + 4 <= sizes.size(); at += 4) {
      header.shape.push_back(word_at(sizes, at));
      if (header.shape.back() > std::numeric_limits<std::int32_t>::max() ||
          (header.count *= header.shape.back()) > kMostNumbers) {
        reader.fail(fmt::format("has a variable of {}", text_of_shape(header.shape)));
      }
    }
    if (header.shape.size() < 2) reader.fail("has a variable without a shape");
    header.name = reader.data(MatType::int8, kLongestName);
    return header;
  }

  void list_values(MatReader& reader, const Header& header, const std::string& name,
                   std::uint64_t end, int depth) {
    constexpr int kDeepest = 8;
    const char* why = nullptr;
    if (header.kind >= MatClass::first_number && header.kind <= MatClass::last_number) {
      if (!header.is_complex) return add(reader, header, name, end);
      why = "is complex, and readings are real";
    } else if (header.kind == MatClass::cell || header.kind == MatClass::structure) {
      if (depth < kDeepest) return list_elements(reader, header, name, end, depth);
      why = "is nested deeply";
    } else {
      why = header.kind == MatClass::text     ? "is a text"
            : header.kind == MatClass::sparse ? "is sparse"
                                              : "is an object or a function";
    }
    names_.refuse(name, fmt::format("{:.100} {}", name, why));
  }

  /// Lists the elements of a cell array or of an array of structs.
  void list_elements(MatReader& reader, const Header& header, const std::string& name,
                     std::uint64_t end, int depth) {
    const bool is_cell = header.kind == MatClass::cell;
    const std::vector<std::string> fields = is_cell ? std::vector<std::string>{""}  //
                                                    : field_names(reader);
    const std::uint64_t elements = header.count * fields.size();
    if (listed_ + elements > kMostVariables) {
      return names_.refuse(name, fmt::format("{:.100} has {} elements, and at most {} are listed",
                                             name, elements, kMostVariables));
    }
    for (std::uint64_t index = 1; index <= header.count; ++index) {
      const std::string element = is_cell             ? fmt::format("{}{{{}}}", name, index)
                                  : header.count == 1 ? name + "."
                                                      : fmt::format("{}({}).", name, index);
      for (const std::string& field : fields) {
        reader.skip_to(list_matrix(reader, element + field, false, end, depth + 1));
      }
    }
  }

  static std::vector<std::string> field_names(MatReader& reader) {
    constexpr std::uint64_t kMostNameBytes = std::uint64_t{64} << 10U;
    const std::string length_data = reader.data(MatType::int32, 4);
    const std::string text = reader.data(MatType::int8, kMostNameBytes);
    const std::uint32_t length = length_data.size() == 4 ? word_at(length_data, 0) : 0;
    if (!text.empty() && (length == 0 || text.size() % length != 0)) {
      reader.fail("has a struct without names");
    }
    std::vector<std::string> fields;
    for (std::size_t at = 0; at < text.size(); at += length) {
      fields.emplace_back(text.substr(at, length).c_str());
    }
    return fields;
  }

  void add(MatReader& reader, const Header& header, const std::string& name, std::uint64_t end) {
    if (header.count == 0) return;
    const MatTag tag = reader.tag();
    const NumberType type = number_type_of(tag.type);
    const std::uint64_t at = reader.at() - (tag.is_small ? tag.small.size() : 0);
    if (type.bytes == 0 || header.count * type.bytes != tag.bytes || at + tag.bytes > end) {
      reader.fail(fmt::format("claims {} numbers for {:.100}, and stores {} bytes of type {}",
                              text_of_shape(header.shape), name, tag.bytes,
                              static_cast<std::uint32_t>(tag.type)));
    }
    std::vector<std::uint64_t> shape = header.shape;
    if (shape.size() == 2 && std::ranges::min(shape) == 1) shape = {header.count};
    names_.add(name, shape.size());
    arrays_.push_back({name, type, std::move(shape), variable_, at});
  }

  /// The numbers of a compressed array.
  [[nodiscard]] std::vector<std::byte> inflated(const MatArray& array,
                                                const std::string& place) const {
    const MatVariable& variable = array.variable;
    if (array.bytes() / kMostDeflateRatio > variable.bytes) {
      throw Error(place, "is smaller than any compression makes it", kDamagedMat);
    }
    std::uint64_t budget = most_inflated(variable.bytes);
    MatReader reader(file_, variable, budget);
    reader.skip_to(array.at);
    if (array.bytes() > budget) {
      throw Error(place,
                  fmt::format("has {} bytes in {}, and at most {} are read of so few",
                              array.bytes(), variable.bytes, most_inflated(variable.bytes)),
                  "save it with -v6 or -v7.3");
    }
    std::vector<std::byte> numbers(array.bytes());
    reader.read(numbers);
    reader.finish();
    return numbers;
  }

  InputFile file_;
  MatVariable variable_;  ///< that is being listed
  std::size_t listed_ = 0;
  std::vector<MatArray> arrays_;
  ArrayNames names_;
};

/// True if a file begins as a MAT-file of version 5, little-endian as all current computers write
/// it.
bool is_mat_5(std::string_view head) {
  return head.size() >= kMatHeaderBytes && head.substr(0, 4).find('\0') == std::string_view::npos &&
         head.substr(kMatHeaderBytes - 4, 4) == std::string_view("\0\1IM", 4);
}

/// True if a file begins as one of version 4: with type, size and name of a matrix.
bool is_mat_4(std::string_view head) {
  constexpr std::size_t kMatrixBytes = 20;
  constexpr std::uint32_t kLongestName = 64;
  if (head.size() < kMatrixBytes) return false;
  const std::uint32_t type = word_at(head, 0);
  const std::uint32_t length = word_at(head, 16);
  return type <= 52 && type % 10 <= 2 && word_at(head, 12) <= 1 && length >= 2 &&
         length <= kLongestName && head.find('\0', kMatrixBytes) == kMatrixBytes + length - 1;
}

/// A plane with its rows as the first axis, of one that is stored column by column.
std::unique_ptr<NumberArray> by_rows(std::unique_ptr<NumberArray> plane) {
  using enum ArrayAxis;
  const std::vector<std::uint64_t> shape = {plane->shape()[1], plane->shape()[0]};
  if (shape[1] > kMostInflatedBytes / (shape[0] * plane->type().bytes)) {
    throw Error(plane->place(), "is larger than 1 GiB, the most that is read of two dimensions",
                "save it with three, rows x columns x frames");
  }
  const auto frame = in_order_of_frames(std::move(plane), {columns, rows});
  std::vector<std::byte> numbers(frame->slice_bytes());
  frame->read(0, 1, numbers.data());
  return array_in_memory(frame->place(), frame->type(), shape, std::move(numbers));
}

/// The source of an array whose axes MATLAB has in the reverse order.
std::unique_ptr<FileSource> source_by_columns(const std::filesystem::path& path,
                                              std::unique_ptr<NumberArray> array,
                                              std::vector<double> times_s,
                                              const ReadOptions& options) {
  using enum ArrayAxis;
  constexpr const char* kFormat = "MATLAB file";
  if (array->shape().size() == 2) {
    return array_source(path, kFormat, by_rows(std::move(array)), std::move(times_s), options);
  }
  std::vector<ArrayAxis> axes =
      options.axes.empty() ? std::vector{frames, rows, columns} : options.axes;
  std::ranges::reverse(axes);
  std::vector<std::uint64_t> shape = array->shape();
  std::ranges::reverse(shape);
  if (shape.size() != axes.size()) {
    throw Error(array->place(), fmt::format("has the shape {}", text_of_shape(shape)),
                options.axes.empty() ? "frames need the shape (frames, rows, columns)"
                                     : "name each axis of the array, or leave out --axes");
  }
  ReadOptions ordered = options;
  if (!ordered.axes.empty()) ordered.axes = {frames, rows, columns};
  return array_source(path, kFormat, in_order_of_frames(std::move(array), axes), std::move(times_s),
                      ordered);
}

std::unique_ptr<FileSource> open_mat(const std::filesystem::path& path,
                                     const ReadOptions& options) {
  if (!is_mat_5(InputFile(path).text_at(0, 128))) {
    throw Error(path.string(), "is a MATLAB file of version 4", "save it with -v7");
  }
  const MatFile file(path);
  std::unique_ptr<NumberArray> readings = file.open(file.names().array_of_frames(options.dataset));
  std::vector<double> times_s;
  const auto times = file.names().array_of_times(options.times);
  if (times) times_s = read_numbers(*file.open(*times));
  return source_by_columns(path, std::move(readings), std::move(times_s), options);
}

}  // namespace

SourceFormat mat_format() {
  return {.name = "MATLAB file (.mat)",
          .recognises = [](std::string_view head) { return is_mat_5(head) || is_mat_4(head); },
          .open = open_mat};
}

}  // namespace pillarfield
