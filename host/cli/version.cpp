// pillarfield --version: build and libraries.

#include "pillarfield/version.h"

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/commit.h"
#include "cli/json_text.h"

namespace pillarfield::cli {

// Asks no OpenCL driver, since a driver that aborts, as PoCL without /sys, would end the program.
void print_version(bool json) {
  if (json) {
    fmt::print("{}\n", json_text({{"version", kVersion},
                                  {"commit", kCommit},
                                  {"compiler", PILLARFIELD_COMPILER},
                                  {"build_type", PILLARFIELD_BUILD_TYPE},
                                  {"hdf5", hdf5_version()}}));
    return;
  }
  fmt::print("pillarfield {}\ncommit    {}\nbuild     {}, {}\nHDF5      {}\n", kVersion, kCommit,
             PILLARFIELD_COMPILER, PILLARFIELD_BUILD_TYPE, hdf5_version());
}

}  // namespace pillarfield::cli
