#include "cli/options/shared_arguments.h"

namespace pillarfield::cli {

void add_help(CLI::App* command) {
  command->set_help_flag("-h,--help", "Print this help and exit")->group("General");
}

void add_general(CLI::App* command, PrintOptions& options, const char* json, const char* quiet) {
  Group general(command, "General");
  general.flag("--json", options.json, json);
  general.flag("-q,--quiet", options.quiet, quiet);
  add_help(command);
}

void add_overwrite(CLI::App* command, Replace& replace) {
  command
      ->add_flag_callback(
          "--overwrite", [&replace] { replace = Replace::anything; },
          "Replace an existing output of any kind; inputs are never replaced")
      ->group("Output");
}

void add_output(CLI::App* command, WriteOptions& options, const std::string& description) {
  Group(command, "Output").text("-o,--output", options.output, "FILE", description)->required();
  add_overwrite(command, options.replace);
}

void add_trust(CLI::App* command, ReadOptions& options) {
  Group(command, "Input")
      .flag("--trust-input", options.trust,
            "Read HDF5 files without checking them first in a separate process");
}

}  // namespace pillarfield::cli
