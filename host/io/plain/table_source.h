#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/file_source.h"
#include "io/plain/number_array.h"

namespace pillarfield {

/// Readings as an array: of uint16 if all are whole numbers from 0 to 65535, else of float32.
[[nodiscard]] std::unique_ptr<NumberArray> array_of(const std::vector<float>& readings,
                                                    std::vector<std::uint64_t> shape,
                                                    std::string place);

/// Opens the table whose names of columns are in line `line`, counted from 1, after lines of words.
[[nodiscard]] std::unique_ptr<FileSource> open_table_after(const std::filesystem::path& path,
                                                           const ReadOptions& options,
                                                           std::uint64_t line);

/// Opens a text whose frames stand between lines of words; null if they are mere comments.
[[nodiscard]] std::unique_ptr<FileSource> open_frames_between_words(
    const std::filesystem::path& path, const ReadOptions& options);

}  // namespace pillarfield
