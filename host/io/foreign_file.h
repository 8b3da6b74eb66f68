#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace pillarfield {

/// Throws Error if a file of frames has a format that is known by its first bytes `head`, or by a
/// folder's files, and is not read; its mend is a command that makes an .npy of it.
void refuse_foreign(const std::filesystem::path& path, std::string_view head);

/// Throws Error as refuse_foreign() does, for an archive of ZIP without arrays of NumPy.
void refuse_foreign_archive(const std::filesystem::path& path, bool is_workbook);

/// "run python3 -c "..."", with names in quotes in `code`: {0} the file, {1} the .npy, {2} the
/// file's folder, {3} a pattern of the files in it that end alike, {4} the file without its ending.
[[nodiscard]] std::string python_line(std::string_view code, const std::filesystem::path& path);

}  // namespace pillarfield
