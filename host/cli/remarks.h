#pragma once

#include <string>
#include <vector>

namespace pillarfield::cli {

/// Prints what a file's reader remarks to standard error, a line each.
void print_file_remarks(const std::string& file, const std::vector<std::string>& remarks);

}  // namespace pillarfield::cli
