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
  std::vector<double> heights;  ///< scaled to [0, 1]; all 1 if flat
};

/// Largest number of rows or columns of a height map.
inline constexpr std::size_t kMaxHeightMapSide = 4096;

/// Reads a relief from a file of NumPy (.npy, two dimensions, whole numbers or floats). Files are
/// untrusted: opens only regular files of at most 160 MiB and checks the header strictly. Throws
/// Error.
[[nodiscard]] HeightMap read_height_map(const std::filesystem::path& path);

/// As above, from the bytes of the file; `name` is its name in messages.
[[nodiscard]] HeightMap parse_npy(const std::vector<std::byte>& bytes, const std::string& name);

}  // namespace pillarfield
