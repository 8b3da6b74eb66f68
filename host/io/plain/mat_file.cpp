#include "io/plain/mat_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include "base/npy.h"
#include "io/plain/mat_reader.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr std::size_t kMatHeaderBytes = 128;
constexpr std::size_t kMatTagBytes = 8;
constexpr std::size_t kMostVariables = 1000;  // cells and fields of structs included

/// The classes of MATLAB's values that the format names, mxCELL_CLASS to mxOPAQUE_CLASS.
enum class MatClass : std::uint8_t {
  cell = 1,
  structure = 2,
  object = 3,
  text = 4,
  sparse = 5,
  first_number = 6,
  last_number = 15,
  opaque = 17
};

std::optional<NumberType> number_type_of(MatType type) {
  using enum NumberType::Kind;
  switch (static_cast<std::uint32_t>(type)) {
    case 1:
      return NumberType{signed_integer, 1};
    case 2:
      return NumberType{unsigned_integer, 1};
    case 3:
      return NumberType{signed_integer, 2};
    case 4:
      return NumberType{unsigned_integer, 2};
    case 5:
      return NumberType{signed_integer, 4};
    case 6:
      return NumberType{unsigned_integer, 4};
    case 7:
      return NumberType{real, 4};
    case 9:
      return NumberType{real, 8};
    case 12:
      return NumberType{signed_integer, 8};
    case 13:
      return NumberType{unsigned_integer, 8};
    default:
      return std::nullopt;
  }
}

/// Lists the arrays of one variable.
class VariableLister {
 public:
  VariableLister(MatReader& reader, std::size_t variable, std::vector<MatArray>& arrays,
                 ArrayNames& names, std::size_t& counted)
      : reader_(reader), variable_(variable), arrays_(arrays), names_(names), counted_(counted) {}

  void list() { list_matrix("", true, std::numeric_limits<std::uint64_t>::max(), 0); }

 private:
  struct Header {
    MatClass kind = {};
    bool is_complex = false;
    std::vector<std::uint64_t> shape;
    std::uint64_t count = 1;
    std::string name;
  };

  /// Lists the matrix that begins here, and returns its end.
  std::uint64_t list_matrix(const std::string& name, bool is_whole, std::uint64_t limit,
                            int depth) {
    const MatTag tag = reader_.tag();
    const std::uint64_t end = reader_.at() + tag.bytes;
    if (tag.type != MatType::matrix || tag.is_small || end > limit) {
      reader_.fail("has an element that is not a matrix, or is longer than what it is part of");
    }
    ++counted_;
    if (tag.bytes == 0) return end;  // an empty cell
    Header header = read_flags();
    if (header.kind == MatClass::opaque) return end;
    read_shape(header);
    if (is_whole && header.name.empty()) return end;  // what MATLAB stores of its own objects
    list_values(header, is_whole ? header.name : name, end, depth);
    return end;
  }

  Header read_flags() {
    const std::string flags = reader_.data(MatType::uint32, 8);
    if (flags.size() != 8) reader_.fail("has a variable without a class");
    const std::uint32_t word = reader_.number(flags.data());
    Header header;
    header.kind = MatClass{static_cast<std::uint8_t>(word & 0xffU)};
    header.is_complex = (word & 0x800U) != 0;
    return header;
  }

  void read_shape(Header& header) {
    constexpr std::uint64_t kMostAxes = 32;
    constexpr std::uint64_t kLongestName = 1000;
    constexpr std::uint64_t kMostNumbers = std::uint64_t{1} << 32U;
    const std::string sizes = reader_.data(MatType::int32, 4 * kMostAxes);
    for (std::size_t at = 0; at + 4 <= sizes.size(); at += 4) {
      header.shape.push_back(reader_.number(&sizes[at]));
      if (header.shape.back() > std::numeric_limits<std::int32_t>::max() ||
          (header.count *= header.shape.back()) > kMostNumbers) {
        reader_.fail(fmt::format("has a variable of {}", text_of_shape(header.shape)));
      }
    }
    if (header.shape.size() < 2) reader_.fail("has a variable without a shape");
    header.name = reader_.data(MatType::int8, kLongestName);
  }

  void list_values(const Header& header, const std::string& name, std::uint64_t end, int depth) {
    constexpr int kDeepest = 8;
    const auto refuse = [&](const char* why) {
      names_.refuse(name, fmt::format("{:.100} {}", name, why));
    };
    if (header.kind >= MatClass::first_number && header.kind <= MatClass::last_number) {
      return header.is_complex ? refuse("is complex, and readings are real")
                               : add(header, name, end);
    }
    switch (header.kind) {
      case MatClass::cell:
        return depth < kDeepest ? list_cells(header, name, end, depth) : refuse("is nested deeply");
      case MatClass::structure:
        return depth < kDeepest ? list_fields(header, name, end, depth)
                                : refuse("is nested deeply");
      case MatClass::text:
        return refuse("is a text");
      case MatClass::sparse:
        return refuse("is sparse");
      default:
        return refuse("is an object or a function");
    }
  }

  /// Whether so many further elements are listed; else they are refused.
  bool has_room(std::uint64_t elements, const std::string& name) {
    if (elements <= kMostVariables - std::min(counted_, kMostVariables)) return true;
    names_.refuse(name, fmt::format("{:.100} has {} elements, and at most {} are listed", name,
                                    elements, kMostVariables));
    return false;
  }

  void list_cells(const Header& header, const std::string& name, std::uint64_t end, int depth) {
    if (!has_room(header.count, name)) return;
    for (std::uint64_t cell = 1; cell <= header.count; ++cell) {
      reader_.skip_to(list_matrix(fmt::format("{}{{{}}}", name, cell), false, end, depth + 1));
    }
  }

  void list_fields(const Header& header, const std::string& name, std::uint64_t end, int depth) {
    constexpr std::uint64_t kMostNameBytes = std::uint64_t{64} << 10U;
    const std::string length_data = reader_.data(MatType::int32, 4);
    const std::uint32_t length = length_data.size() == 4 ? reader_.number(length_data.data()) : 0;
    const std::string fields = reader_.data(MatType::int8, kMostNameBytes);
    if (fields.empty()) return;
    if (length == 0 || fields.size() % length != 0) reader_.fail("has a struct without names");
    if (!has_room(header.count * (fields.size() / length), name)) return;
    for (std::uint64_t index = 1; index <= header.count; ++index) {
      const std::string element = header.count == 1 ? name : fmt::format("{}({})", name, index);
      for (std::size_t at = 0; at < fields.size(); at += length) {
        std::string field = fields.substr(at, length);
        field.resize(std::min(field.find('\0'), field.size()));
        reader_.skip_to(list_matrix(fmt::format("{}.{}", element, field), false, end, depth + 1));
      }
    }
  }

  void add(const Header& header, const std::string& name, std::uint64_t end) {
    if (header.count == 0) return;
    const MatTag tag = reader_.tag();
    const auto type = number_type_of(tag.type);
    const std::uint64_t at = reader_.at() - (tag.is_small ? tag.small.size() : 0);
    if (!type || header.count * type->bytes != tag.bytes || at + tag.bytes > end) {
      reader_.fail(fmt::format("claims {} numbers for {:.100}, and stores {} bytes of type {}",
                               text_of_shape(header.shape), name, tag.bytes,
                               static_cast<std::uint32_t>(tag.type)));
    }
    std::vector<std::uint64_t> shape = header.shape;
    if (shape.size() == 2 && std::ranges::min(shape) == 1) shape = {header.count};
    names_.add(name, shape.size());
    arrays_.push_back({name, *type, std::move(shape), variable_, at});
  }

  MatReader& reader_;
  std::size_t variable_;
  std::vector<MatArray>& arrays_;
  ArrayNames& names_;
  std::size_t& counted_;
};

}  // namespace

bool is_mat_5(std::string_view head) {
  if (head.size() < kMatHeaderBytes || head.substr(0, 4).find('\0') != std::string_view::npos) {
    return false;
  }
  const std::string_view version = head.substr(kMatHeaderBytes - 4, 4);
  return version == std::string_view("\0\1IM", 4) || version == std::string_view("\1\0MI", 4);
}

bool is_mat_4(std::string_view head) {
  constexpr std::size_t kMatrixBytes = 20;
  constexpr std::uint32_t kLongestName = 64;
  if (head.size() < kMatrixBytes) return false;
  std::array<std::uint32_t, 5> words{};  // type, rows, columns, is complex, length of the name
  std::memcpy(words.data(), head.data(), kMatrixBytes);
  for (int order = 0; order < 2; ++order) {
    const std::uint32_t type = words[0];
    const std::uint32_t length = words[4];
    if (type <= 4052 && type / 100 % 10 == 0 && type / 10 % 10 <= 5 && type % 10 <= 2 &&
        words[3] <= 1 && length >= 2 && length <= kLongestName &&
        head.size() >= kMatrixBytes + length &&
        head.substr(kMatrixBytes, length).find('\0') == length - 1) {
      return true;
    }
    swap_bytes(reinterpret_cast<std::byte*>(words.data()), words.size(), sizeof words[0]);
  }
  return false;
}

std::uint64_t MatArray::bytes() const {
  std::uint64_t bytes = type.bytes;
  for (const std::uint64_t size : shape) bytes *= size;
  return bytes;
}

MatFile::MatFile(const std::filesystem::path& path) : file_(path), names_(path) {
  const std::string head = file_.text_at(0, kMatHeaderBytes);
  const bool is_little = head.ends_with("IM");
  is_swapped_ = is_little != (std::endian::native == std::endian::little);
  list_variables();
  std::size_t counted = 0;
  std::uint64_t budget = most_inflated(file_.size());
  for (std::size_t index = 0; index < variables_.size(); ++index) {
    MatReader reader(file_, variables_[index], is_swapped_, budget);
    VariableLister(reader, index, arrays_, names_, counted).list();
  }
}

/// Finds the variables of the file by their tags.
void MatFile::list_variables() {
  std::uint64_t budget = 0;
  const MatVariable whole = {.at = 0, .bytes = file_.size()};
  MatReader reader(file_, whole, is_swapped_, budget);
  for (std::uint64_t at = kMatHeaderBytes; at < file_.size();) {
    reader.skip_to(at);
    const MatTag tag = reader.tag();
    const bool is_compressed = tag.type == MatType::compressed;
    if (tag.is_small || (!is_compressed && tag.type != MatType::matrix)) {
      reader.fail(fmt::format("has an element of type {} at byte {}",
                              static_cast<std::uint32_t>(tag.type), at));
    }
    reader.skip_to(at + kMatTagBytes + tag.bytes);
    if (variables_.size() == kMostVariables) {
      throw Error(file_.path().string(), fmt::format("has more than {} variables", kMostVariables),
                  "save the frames alone");
    }
    if (is_compressed) {
      variables_.push_back({at + kMatTagBytes, tag.bytes, true});
    } else {
      variables_.push_back({at, kMatTagBytes + tag.bytes, false});
    }
    at = reader.at();
  }
}

std::unique_ptr<NumberArray> MatFile::open(std::size_t index) const {
  const MatArray& array = arrays_[index];
  const MatVariable& variable = variables_[array.variable];
  std::string place = fmt::format("{}: {:.100}", file_.path().string(), array.name);
  std::vector<std::uint64_t> shape(array.shape.rbegin(), array.shape.rend());
  if (!variable.is_compressed) {
    return array_in_file(InputFile(file_.path()), variable.at + array.at, is_swapped_,
                         std::move(place), array.type, std::move(shape));
  }
  std::vector<std::byte> numbers = inflated(array, place);
  if (is_swapped_) swap_bytes(numbers.data(), numbers.size() / array.type.bytes, array.type.bytes);
  return array_in_memory(std::move(place), array.type, std::move(shape), std::move(numbers));
}

/// The numbers of a compressed array.
std::vector<std::byte> MatFile::inflated(const MatArray& array, const std::string& place) const {
  const MatVariable& variable = variables_[array.variable];
  if (array.bytes() / kMostDeflateRatio > variable.bytes) {
    throw Error(place, "is smaller than any compression makes it", kDamagedMat);
  }
  const std::uint64_t most = most_inflated(variable.bytes);
  std::uint64_t budget = most;
  MatReader reader(file_, variable, is_swapped_, budget);
  reader.skip_to(array.at);
  if (array.bytes() > budget) {
    throw Error(place,
                fmt::format("has {} bytes in {}, and at most {} are read of so few", array.bytes(),
                            variable.bytes, most),
                "save it with -v6 or -v7.3");
  }
  std::vector<std::byte> numbers(array.bytes());
  reader.read(numbers);
  reader.finish();
  return numbers;
}

}  // namespace pillarfield
