#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/plain/stated_words.h"
#include "pillarfield/error.h"
#include "pillarfield/read_options.h"

namespace pillarfield {

/// Most readings of a table: 512 MiB of them.
inline constexpr std::size_t kMostTableReadings = std::size_t{1} << 27U;

/// Readings and times of a table.
struct Table {
  std::vector<float> readings;
  std::vector<double> times;  ///< of each line, or none
  double time_unit_s = 0;     ///< 0 if the column states none
  std::uint64_t lines = 0;    ///< with numbers
  std::uint64_t blocks = 0;   ///< of lines, between blank ones or dashes
  std::size_t cells = 0;      ///< readings of a line
  std::uint64_t rows = 0;     ///< of each block
  std::optional<FrameSize> size;
  std::vector<std::uint64_t> long_shape;  ///< of a table with one reading a line
  StatedWords words;
  std::vector<std::string> notes;
  /// Lines of words stand between lines that are rows of frames.
  bool has_words_between = false;
  std::optional<Error> refusal;  ///< of rows of frames that are cut
};

/// Reads a table. `header_line` is the number of the line of names, if words precede it; 0: none
/// do.
[[nodiscard]] Table parse_table(const std::filesystem::path& path, const ReadOptions& options,
                                std::uint64_t header_line);

}  // namespace pillarfield
