#pragma once

#include <functional>
#include <stdexcept>

namespace pillarfield::cli {

/// A wrong command line; the message is one line with the place and the remedy.
struct WrongCommandLine : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Returns the work of the command line, which throws Error where it fails. --help prints the help
/// and returns empty work. Throws WrongCommandLine.
[[nodiscard]] std::function<void()> parse_arguments(int argc, char** argv);

}  // namespace pillarfield::cli
