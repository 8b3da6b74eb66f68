#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "pillarfield/error.h"
#include "simulation/body/height_map.h"

namespace pillarfield {
namespace {

static_assert(std::endian::native == std::endian::little);

/// A number type of .npy files, and its reader.
struct NpyType {
  std::string_view descr;
  std::size_t size;
  double (*read)(const std::byte* from);
};

template <class Number>
double read_npy_number(const std::byte* from) {
  Number number;
  std::memcpy(&number, from, sizeof number);
  return static_cast<double>(number);
}

constexpr std::array<NpyType, 10> kNpyTypes = {{
    {"|u1", 1, read_npy_number<std::uint8_t>},
    {"|i1", 1, read_npy_number<std::int8_t>},
    {"|b1", 1, read_npy_number<std::uint8_t>},
    {"<u2", 2, read_npy_number<std::uint16_t>},
    {"<i2", 2, read_npy_number<std::int16_t>},
    {"<u4", 4, read_npy_number<std::uint32_t>},
    {"<i4", 4, read_npy_number<std::int32_t>},
    {"<f4", 4, read_npy_number<float>},
    {"<f8", 8, read_npy_number<double>},
    {"<i8", 8, read_npy_number<std::int64_t>},
}};

struct NpyHeader {
  const NpyType* type = nullptr;
  bool by_columns = false;
  std::array<std::size_t, 2> shape = {};
};

/// Parses the header, a Python dictionary of three entries.
class NpyHeaderReader {
 public:
  NpyHeaderReader(std::string_view text, const std::string& name) : rest_(text), name_(name) {}

  NpyHeader read() {
    NpyHeader header;
    std::array<bool, 3> seen = {};
    expect('{');
    while (!accept('}')) {
      const std::string_view key = quoted_text();
      expect(':');
      if (key == "descr") {
        mark(seen[0]);
        header.type = type();
      } else if (key == "fortran_order") {
        mark(seen[1]);
        header.by_columns = truth();
      } else if (key == "shape") {
        mark(seen[2]);
        header.shape = shape();
      } else {
        fail("has an unknown key in its header");
      }
      if (!accept(',')) {
        expect('}');
        break;
      }
    }
    skip_blanks();
    if (!rest_.empty() || !std::ranges::all_of(seen, [](bool is) { return is; })) {
      fail("has a header that is not complete");
    }
    return header;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw Error(name_, why, "save a two-dimensional array with numpy.save()");
  }

  void mark(bool& seen) const {
    if (seen) fail("has a key twice in its header");
    seen = true;
  }

  void skip_blanks() {
    const std::size_t blanks = rest_.find_first_not_of(" \n");
    rest_.remove_prefix(std::min(blanks, rest_.size()));
  }

  bool accept(char wanted) {
    skip_blanks();
    if (rest_.empty() || rest_.front() != wanted) return false;
    rest_.remove_prefix(1);
    return true;
  }

  void expect(char wanted) {
    if (!accept(wanted)) fail("has a header that is no dictionary");
  }

  std::string_view quoted_text() {
    expect('\'');
    const std::size_t end = rest_.find('\'');
    if (end == std::string_view::npos) fail("has a header that is no dictionary");
    const std::string_view text = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return text;
  }

  const NpyType* type() {
    const std::string_view descr = quoted_text();
    const auto* const known = std::ranges::find(kNpyTypes, descr, &NpyType::descr);
    if (known == kNpyTypes.end()) {
      fail(fmt::format("has numbers of type '{:.20}', not little-endian whole numbers or floats",
                       descr));
    }
    return &*known;
  }

  bool truth() {
    skip_blanks();
    for (const bool value : {false, true}) {
      const std::string_view word = value ? "True" : "False";
      if (!rest_.starts_with(word)) continue;
      rest_.remove_prefix(word.size());
      return value;
    }
    fail("has a header whose fortran_order is neither True nor False");
  }

  std::size_t side() {
    skip_blanks();
    std::size_t count = 0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), count);
    if (error != std::errc()) fail("has a shape that is not two whole numbers");
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    if (count < 2 || count > kMaxHeightMapSide) {
      fail(fmt::format("has {} rows or columns, not 2 to {}", count, kMaxHeightMapSide));
    }
    return count;
  }

  std::array<std::size_t, 2> shape() {
    expect('(');
    const std::size_t rows = side();
    if (!accept(',')) fail("has a shape that is not two whole numbers");
    const std::size_t cols = side();
    accept(',');
    if (!accept(')')) fail("has a shape that is not two whole numbers");
    return {rows, cols};
  }

  std::string_view rest_;
  const std::string& name_;
};

/// The header's text and the offset of the numbers.
struct NpyParts {
  std::string_view header;
  std::size_t data;
};

NpyParts npy_parts(const std::vector<std::byte>& bytes, const std::string& name) {
  constexpr std::string_view kMagic = "\x93NUMPY";
  constexpr std::size_t kMostHeader = 4096;
  const auto byte = [&](std::size_t at) { return std::to_integer<std::size_t>(bytes[at]); };
  const Error no_npy(name, "is no .npy file", "save a two-dimensional array with numpy.save()");
  if (bytes.size() < 12 || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0) {
    throw no_npy;
  }
  const bool is_short = byte(6) == 1;
  if (byte(6) < 1 || byte(6) > 3 || byte(7) != 0) throw no_npy;
  std::size_t length = byte(8) + (byte(9) << 8U);
  if (!is_short) length += (byte(10) << 16U) + (byte(11) << 24U);
  const std::size_t begin = is_short ? 10 : 12;
  if (length > kMostHeader || bytes.size() - begin < length) throw no_npy;
  return {{reinterpret_cast<const char*>(bytes.data()) + begin, length}, begin + length};
}

}  // namespace

HeightMap parse_npy(const std::vector<std::byte>& bytes, const std::string& name) {
  const NpyParts parts = npy_parts(bytes, name);
  const NpyHeader header = NpyHeaderReader(parts.header, name).read();
  const auto [rows, cols] = header.shape;
  const std::size_t expected = rows * cols * header.type->size;
  if (bytes.size() - parts.data != expected) {
    throw Error(name,
                fmt::format("has {} bytes of numbers, not the {} of its header",
                            bytes.size() - parts.data, expected),
                "save the array again");
  }
  std::vector<double> values(rows * cols);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t col = 0; col < cols; ++col) {
      const std::size_t at = header.by_columns ? col * rows + row : row * cols + col;
      values[row * cols + col] =
          header.type->read(bytes.data() + parts.data + at * header.type->size);
    }
  }
  return height_map_of(rows, cols, std::move(values), name);
}

}  // namespace pillarfield
