#pragma once

#include <CLI/CLI.hpp>

#include "pillarfield/output_file.h"

namespace pillarfield::cli {

/// --overwrite: sets `replace`, which must outlive the command, to Replace::anything.
void add_overwrite_option(CLI::App& command, Replace& replace);

}  // namespace pillarfield::cli
