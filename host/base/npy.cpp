#include "base/npy.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <limits>
#include <optional>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr const char* kDamagedHeader = "the file is damaged; save it again with numpy.save";

/// Splits the header, the text of a Python dictionary.
class DictionaryText {
 public:
  DictionaryText(std::string_view text, const std::string& place) : rest_(text), place_(place) {}

  /// Skips blanks and takes `word` if it comes next.
  bool take(std::string_view word) {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \n"), rest_.size()));
    if (!rest_.starts_with(word)) return false;
    rest_.remove_prefix(word.size());
    return true;
  }

  void require(std::string_view word) {
    if (!take(word)) fail();
  }

  std::string_view quoted() {
    const char quote = take("'") ? '\'' : '"';
    if (quote == '"') require("\"");
    const std::size_t end = rest_.find(quote);
    if (end == std::string_view::npos) fail();
    const std::string_view text = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return text;
  }

  std::vector<std::uint64_t> tuple() {
    std::vector<std::uint64_t> values;
    require("(");
    while (!take(")")) {
      values.push_back(whole());
      static_cast<void>(take("L"));  // of Python 2
      if (!take(",")) {
        require(")");
        break;
      }
    }
    return values;
  }

  [[noreturn]] void fail() const {
    throw Error(place_, "its header is not that of a NumPy array", kDamagedHeader);
  }

 private:
  std::uint64_t whole() {
    static_cast<void>(take(""));
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc{}) fail();
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return value;
  }

  std::string_view rest_;
  const std::string& place_;
};

std::string name_of_kind(char kind, std::string_view size) {
  switch (kind) {
    case 'f':
      return size == "2" ? "float16" : fmt::format("float of {:.20} bytes", size);
    case 'c':
      return "complex";
    case 'O':
      return "Python objects";
    case 'S':
    case 'U':
      return "text";
    default:
      return fmt::format("type '{:.1}{:.20}'", std::string_view(&kind, 1), size);
  }
}

/// Sets type and byte order from a `descr` such as "<u2".
void take_type(std::string_view descr, NpyHeader& header, const std::string& place) {
  const bool has_order =
      !descr.empty() && std::string_view("<>|=").find(descr[0]) != std::string_view::npos;
  const char order = has_order ? descr[0] : '=';
  if (has_order) descr.remove_prefix(1);
  const char kind = descr.empty() ? '?' : descr[0];
  const std::string_view size = descr.substr(std::min<std::size_t>(1, descr.size()));
  const bool is_whole =
      (kind == 'u' || kind == 'i') && (size == "1" || size == "2" || size == "4" || size == "8");
  header.is_boolean = kind == 'b' && size == "1";
  if (!is_whole && !header.is_boolean && !(kind == 'f' && (size == "4" || size == "8"))) {
    throw Error(place, fmt::format("holds {}, which is not read", name_of_kind(kind, size)),
                "store integers, float32 or float64");
  }
  using Kind = NumberType::Kind;
  header.type.kind = kind == 'f'   ? Kind::real
                     : kind == 'i' ? Kind::signed_integer
                                   : Kind::unsigned_integer;
  header.type.bytes = static_cast<std::size_t>(size[0] - '0');
  constexpr bool kLittle = std::endian::native == std::endian::little;
  header.is_swapped = header.type.bytes > 1 && order == (kLittle ? '>' : '<');
}

/// Bytes of all numbers; unset beyond 64 bits.
std::optional<std::uint64_t> bytes_of(const NpyHeader& header) {
  std::uint64_t bytes = header.type.bytes;
  if (std::ranges::find(header.shape, 0U) != header.shape.end()) return 0;
  for (const std::uint64_t size : header.shape) {
    if (size > (std::numeric_limits<std::uint64_t>::max() >> 1U) / bytes) return std::nullopt;
    bytes *= size;
  }
  return bytes;
}

NpyHeader parse_dictionary(std::string_view text, const std::string& place) {
  NpyHeader header;
  DictionaryText dictionary(text, place);
  bool has_type = false;
  bool has_order = false;
  dictionary.require("{");
  while (!dictionary.take("}")) {
    const std::string_view key = dictionary.quoted();
    dictionary.require(":");
    if (key == "descr" && dictionary.take("[")) {
      throw Error(place, "holds records, as the forces written by solve",
                  "give an array of readings, numbers of one type");
    }
    if (key == "descr") {
      take_type(dictionary.quoted(), header, place);
      has_type = true;
    } else if (key == "fortran_order") {
      header.by_columns = dictionary.take("True");
      if (!header.by_columns) dictionary.require("False");
      has_order = true;
    } else if (key == "shape") {
      header.shape = dictionary.tuple();
    } else {
      dictionary.fail();
    }
    if (!dictionary.take(",")) {
      dictionary.require("}");
      break;
    }
  }
  if (!has_type || !has_order) dictionary.fail();
  return header;
}

}  // namespace

NpyHeader parse_npy_header(std::string_view head, const std::string& place) {
  constexpr std::size_t kVersionAt = 6;
  constexpr std::size_t kLengthAt = 8;
  if (!head.starts_with(kNpyMagic) || head.size() < kLengthAt + 4) {
    throw Error(place, "does not begin as a NumPy array", kDamagedHeader);
  }
  const int version = static_cast<unsigned char>(head[kVersionAt]);
  if (version < 1 || version > 3) {
    throw Error(place, fmt::format("is a NumPy array of version {}", version),
                "versions 1 to 3 are read");
  }
  const std::size_t length_bytes = version == 1 ? 2 : 4;
  std::uint64_t length = 0;
  for (std::size_t i = length_bytes; i-- > 0;) {
    length = length << 8U | static_cast<unsigned char>(head[kLengthAt + i]);
  }
  const std::size_t begin = kLengthAt + length_bytes;
  if (length > head.size() - begin) {
    throw Error(place, fmt::format("its header claims {} bytes", length), kDamagedHeader);
  }
  NpyHeader header = parse_dictionary(head.substr(begin, length), place);
  header.bytes = begin + length;
  const auto data_bytes = bytes_of(header);
  if (header.shape.empty() || header.shape.size() > 32 || !data_bytes) {
    throw Error(place, fmt::format("has the shape ({})", text_of_shape(header.shape)),
                "save an array of at least one axis");
  }
  header.data_bytes = *data_bytes;
  return header;
}

void swap_bytes(std::byte* numbers, std::size_t count, std::size_t number_bytes) {
  for (std::size_t i = 0; i < count; ++i) {
    std::reverse(numbers + i * number_bytes, numbers + (i + 1) * number_bytes);
  }
}

}  // namespace pillarfield
