#pragma once

#include <functional>
#include <stdexcept>

namespace pillarfield::cli {

/// A command line that is wrong: one line that says where, and the mend.
struct WrongCommandLine : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What the command line asks for, to be called; throws Error where the work fails. Throws
/// WrongCommandLine. Prints what --help asks for and returns nothing to do then.
[[nodiscard]] std::function<void()> parse_arguments(int argc, char** argv);

}  // namespace pillarfield::cli
