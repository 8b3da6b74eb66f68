#include "simulation/indenter/height_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "base/input_file.h"
#include "base/npy.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

std::vector<std::byte> bytes_of_height_map(const std::filesystem::path& path) {
  constexpr std::uintmax_t kMostBytes = std::uintmax_t{160} << 20U;
  const InputFile file(path, kMostBytes);
  std::vector<std::byte> bytes(file.size());
  file.read(0, bytes);
  return bytes;
}

/// Scales values to [0, 1]. Throws Error if one is not finite.
HeightMap height_map_of(std::size_t rows, std::size_t cols, std::vector<double> values,
                        const std::string& name) {
  const auto bad = std::find_if_not(values.begin(), values.end(),
                                    [](double value) { return std::isfinite(value); });
  if (bad != values.end()) {
    const auto index = static_cast<std::size_t>(bad - values.begin());
    throw Error(name, fmt::format("row {}, column {} is {}", index / cols, index % cols, *bad),
                "heights must be finite");
  }
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double low = *least;
  const double range = *most - low;
  if (!std::isfinite(range)) throw Error(name, "heights differ too much", "keep them below 1e300");
  for (double& value : values) value = range > 0 ? (value - low) / range : 1;
  return {rows, cols, std::move(values)};
}

}  // namespace

HeightMap read_height_map(const std::filesystem::path& path) {
  const std::string name = path.string();
  if (path.extension() == ".npy") return parse_npy(bytes_of_height_map(path), name);
  throw Error(name, "is not a height map", "name a file that ends in .npy");
}

namespace {

void check_sides(const NpyHeader& header, const std::string& name) {
  constexpr const char* kSave = "save a two-dimensional array with numpy.save()";
  if (header.shape.size() != 2) {
    throw Error(name, fmt::format("has the shape {}", text_of_shape(header.shape)), kSave);
  }
  for (const std::uint64_t side : header.shape) {
    if (side >= 2 && side <= kMaxHeightMapSide) continue;
    throw Error(name, fmt::format("has {} rows or columns, not 2 to {}", side, kMaxHeightMapSide),
                kSave);
  }
}

/// Values row by row from values column by column.
std::vector<double> by_rows(const std::vector<double>& values, std::size_t rows, std::size_t cols) {
  std::vector<double> ordered(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) ordered[i % rows * cols + i / rows] = values[i];
  return ordered;
}

}  // namespace

HeightMap parse_npy(const std::vector<std::byte>& bytes, const std::string& name) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const NpyHeader header = parse_npy_header(text.substr(0, kLongestNpyHeader), name);
  check_sides(header, name);
  if (bytes.size() - header.bytes != header.data_bytes) {
    throw Error(name,
                fmt::format("has {} bytes of numbers, not the {} of its header",
                            bytes.size() - header.bytes, header.data_bytes),
                "save the array again");
  }
  std::vector<std::byte> numbers(bytes.begin() + static_cast<std::ptrdiff_t>(header.bytes),
                                 bytes.end());
  if (header.is_swapped) {
    swap_bytes(numbers.data(), numbers.size() / header.type.bytes, header.type.bytes);
  }
  const std::size_t rows = header.shape[0];
  const std::size_t cols = header.shape[1];
  std::vector<double> values = doubles_of(header.type, numbers);
  if (header.by_columns) values = by_rows(values, rows, cols);
  return height_map_of(rows, cols, std::move(values), name);
}

}  // namespace pillarfield
