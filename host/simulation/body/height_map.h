#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace pillarfield {

/// A relief on a grid: rows from the top (+y), columns from the left.
struct HeightMap {
  std::size_t rows = 0;
  std::size_t cols = 0;
  std::vector<double> heights;  ///< from 0, the least, to 1, the largest; all 1 where it is flat
};

/// Rows or columns of a height map.
inline constexpr std::size_t kMaxHeightMapSide = 4096;

/// Reads a relief from a file of NumPy (.npy, two dimensions, whole numbers of up to 32 bits or
/// floats, little-endian) or a picture (.png, grey, 8 or 16 bits). Files are taken for hostile:
/// only a regular file of at most 160 MiB is opened, and its header is read strictly. Throws Error.
[[nodiscard]] HeightMap read_height_map(const std::filesystem::path& path);

/// The same of a .npy or .png file's bytes; `name` stands for the file in messages.
[[nodiscard]] HeightMap parse_npy(const std::vector<std::byte>& bytes, const std::string& name);
[[nodiscard]] HeightMap parse_png(const std::vector<std::byte>& bytes, const std::string& name);

/// Makes values heights between 0 and 1. Throws Error where one is not finite.
[[nodiscard]] HeightMap height_map_of(std::size_t rows, std::size_t cols,
                                      std::vector<double> values, const std::string& name);

}  // namespace pillarfield
