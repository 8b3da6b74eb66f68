#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "pillarfield/live.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// Distance of the marks of FlexiTac frames, bytes: the shortest at which marks follow each other
/// from one of the first on to the end of the bytes, eight at least. Unset without, and for other
/// boards whose frames begin alike: their head goes on, or their readings are no multiple of four.
[[nodiscard]] std::optional<std::size_t> mark_distance(std::span<const std::byte> bytes);

/// The bytes of an unknown board in words: lines of text, or frames and their head if they repeat.
/// Empty for others.
[[nodiscard]] std::string words_on_bytes(std::span<const std::byte> bytes);

/// Rows and columns of `readings`: of all sizes the nearest to a square, with no more rows than
/// columns. Unset if there is none of two rows.
[[nodiscard]] std::optional<FrameSize> likely_size(std::size_t readings);

/// A serial device on which frames of a FlexiTac board arrive.
struct FoundBoard {
  std::string device;
  std::size_t readings = 0;  ///< of a frame
};

/// Listens to each serial device that matches, a second at most, until one has frames of a FlexiTac
/// board. `pattern` is that of file names, with `*`, or `auto` for all USB lines. `open` opens a
/// device, or returns -1 and sets errno. Unset if options.stop gave up. Throws Error, which names
/// each device and what was heard, if none has frames.
[[nodiscard]] std::optional<FoundBoard> find_board(
    const std::string& pattern, const LiveSourceOptions& options,
    const std::function<int(const std::string&)>& open);

}  // namespace pillarfield
