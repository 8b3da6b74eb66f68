#include "simulation/indenter/height_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/input_file.h"
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

}  // namespace

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

HeightMap read_height_map(const std::filesystem::path& path) {
  const std::string name = path.string();
  if (path.extension() == ".npy") return parse_npy(bytes_of_height_map(path), name);
  if (path.extension() == ".png") return parse_png(bytes_of_height_map(path), name);
  throw Error(name, "is not a height map", "name a file that ends in .npy or .png");
}

}  // namespace pillarfield
