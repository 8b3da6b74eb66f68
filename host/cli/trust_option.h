#pragma once

#include <CLI/CLI.hpp>

#include "pillarfield/read_options.h"

namespace pillarfield::cli {

/// --trust-input.
inline void add_trust_option(CLI::App& command, ReadOptions& options) {
  command.add_flag("--trust-input", options.trust,
                   "Do not try HDF5 files in a process of their own before they are read");
}

}  // namespace pillarfield::cli
