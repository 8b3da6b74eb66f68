#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace pillarfield {

class FrameSource;

/// The items along an axis of an array of readings.
enum class ArrayAxis : std::uint8_t { frames, rows, columns };

/// Parses the order of an array's axes, the first one first: the words frames, rows and columns,
/// separated by commas; rows and columns alone for an array of one frame. Throws Error.
[[nodiscard]] std::vector<ArrayAxis> parse_axes(std::string_view words);

/// Throws Error, naming `place`, if an array of unknown axes, read as [frames, rows, columns], more
/// likely has its frames along another axis: that axis is longer than the first, and the ratio of
/// the elongations of a frame times that of the variations along both axes is above 2.5. Reads at
/// most 16 frames.
void require_likely_axes(FrameSource& frames, const std::string& place);

/// Numbers of element `index` of an array's first axis, in C order.
using SliceReader = std::function<std::vector<double>(std::uint64_t index)>;

/// Throws Error, naming `place`, for an array with axes that are not those of frames: components,
/// [T, N, 3], [T, R, C, 3], [T, 3, R, C] or signed [3, R, C], pads, [T, B, R, C], or both. The mend
/// is that of `take`, which gets the index that takes the normal component of one pad, "[..., 2]",
/// or with K where the numbers do not tell which it is. Reads at most 64 slices.
void require_frame_axes(const std::vector<std::uint64_t>& shape, const SliceReader& read,
                        const std::string& place,
                        const std::function<std::string(const std::string& index)>& take);

/// Throws Error, naming `place`, if a two-dimensional array is too elongated for one frame: more
/// likely each of its lines is a frame.
void require_likely_frame(std::uint64_t rows, std::uint64_t cols, const std::string& place);

/// Sentences about an odd last row or column, which has no pillars.
[[nodiscard]] std::vector<std::string> size_warnings(std::uint32_t rows, std::uint32_t cols);

}  // namespace pillarfield
