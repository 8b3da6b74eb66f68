// The `pillarfield` command. Exit status: 0 done, 1 the work failed, 2 the command line was wrong.

#include <cstdio>
#include <exception>

#include "cli/arguments.h"
#include "pillarfield/interrupt.h"
#include "pillarfield/printable.h"

namespace pillarfield::cli {
namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongCommandLine = 2;

/// For use where nothing may throw any more.
int complain(const char* message) noexcept {
  std::fprintf(stderr, "pillarfield: %s\n", message);
  return kFailed;
}

/// The same for a text that may hold anything, as that of a system's error with a file's name.
int complain_of(const std::exception& error) noexcept {
  try {
    return complain(printable(error.what()).c_str());
  } catch (...) {
    return complain("out of memory");
  }
}

int run(int argc, char** argv) {
  const std::function<void()> work = parse_arguments(argc, argv);
  catch_interrupts();
  work();
  if (std::fflush(stdout) != 0) return complain("standard output cannot be written");
  return kDone;
}

}  // namespace
}  // namespace pillarfield::cli

int main(int argc, char** argv) {
  try {
    return pillarfield::cli::run(argc, argv);
  } catch (const pillarfield::cli::WrongCommandLine& error) {
    pillarfield::cli::complain_of(error);
    return pillarfield::cli::kWrongCommandLine;
  } catch (const std::bad_alloc&) {
    return pillarfield::cli::complain("out of memory; take a smaller patch");
  } catch (const std::exception& error) {
    return pillarfield::cli::complain_of(error);
  } catch (...) {
    return pillarfield::cli::complain("an unknown failure; please report it");
  }
}
