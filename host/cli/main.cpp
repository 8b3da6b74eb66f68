// The `pillarfield` command. Exit status: 0 done, 1 the work failed, 2 the command line was wrong.

#include <cstdio>
#include <exception>

#include "cli/command.h"
#include "pillarfield/interrupt.h"
#include "pillarfield/printable.h"
#include "pillarfield/version.h"

namespace pillarfield::cli {
namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongCommandLine = 2;

constexpr const char* kFooter = R"(
Try:  pillarfield simulate scenes/demo.toml -o demo.h5
      pillarfield solve demo.h5 -o forces.h5
      pillarfield compare forces.h5 demo.h5)";

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
  CLI::App app("Turns frames of a high-density artificial skin into fields of three-axis force.",
               "pillarfield");
  app.set_version_flag("--version", kVersion, "Print the version and exit");
  app.require_subcommand(1);
  app.footer(kFooter);
  Work work;
  add_simulate(app, work);
  add_solve(app, work);
  add_live(app, work);
  add_compare(app, work);
  add_calibrate(app, work);
  add_testbed(app, work);
  add_info(app, work);
  add_completion(app, work);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kWrongCommandLine;
  }
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
  } catch (const std::bad_alloc&) {
    return pillarfield::cli::complain("out of memory; take a smaller patch");
  } catch (const std::exception& error) {
    return pillarfield::cli::complain_of(error);
  } catch (...) {
    return pillarfield::cli::complain("an unknown failure; please report it");
  }
}
