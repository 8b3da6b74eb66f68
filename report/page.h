#pragma once

#include <filesystem>
#include <string>

namespace pillarfield::report {

/// Writes a page. Throws Error where the file cannot be written.
void write_page(const std::filesystem::path& path, const std::string& text);

}  // namespace pillarfield::report
