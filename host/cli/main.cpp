// The `pillarfield` command. Exit status: 0 done, 1 the work failed, 2 the command line was wrong.

#include <cstdio>
#include <exception>

#include "cli/options/arguments.h"
#include "pillarfield/interrupt.h"
#include "pillarfield/printable.h"

namespace pillarfield::cli {
namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongCommandLine = 2;

int print_error(const char* message) noexcept {
  std::fprintf(stderr, "pillarfield: %s\n", message);
  return kFailed;
}

/// Escapes the message, which may contain the name of a file.
int print_error(const std::exception& error) noexcept {
  try {
    return print_error(printable(error.what()).c_str());
  } catch (...) {
    return print_error("out of memory");
  }
}

int run(int argc, char** argv) {
  const std::function<void()> work = parse_arguments(argc, argv);
  catch_interrupts();
  work();
  if (std::fflush(stdout) != 0) return print_error("standard output cannot be written");
  return kDone;
}

}  // namespace
}  // namespace pillarfield::cli

int main(int argc, char** argv) {
  try {
    return pillarfield::cli::run(argc, argv);
  } catch (const pillarfield::cli::WrongCommandLine& error) {
    pillarfield::cli::print_error(error);
    return pillarfield::cli::kWrongCommandLine;
  } catch (const std::bad_alloc&) {
    return pillarfield::cli::print_error("out of memory; use a smaller patch");
  } catch (const std::exception& error) {
    return pillarfield::cli::print_error(error);
  } catch (...) {
    return pillarfield::cli::print_error("unknown failure; please report it");
  }
}
