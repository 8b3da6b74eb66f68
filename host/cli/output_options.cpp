#include "cli/output_options.h"

namespace pillarfield::cli {

void add_overwrite_option(CLI::App& command, Replace& replace) {
  command.add_flag_callback(
      "--overwrite", [&replace] { replace = Replace::anything; },
      "Replace an output that exists, whatever it holds; never a file that is read");
}

}  // namespace pillarfield::cli
