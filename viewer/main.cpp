// The `pillarfield-viewer` command. Exit status: 0 done, 1 the work failed, 2 the command line was
// wrong.

#include <cstdio>
#include <exception>
#include <new>

#include "pillarfield/interrupt.h"
#include "pillarfield/printable.h"
#include "viewer/app/app.h"

namespace {

constexpr int kFailed = 1;

int complain(const char* message) noexcept {
  std::fprintf(stderr, "pillarfield-viewer: %s\n", message);
  return kFailed;
}

/// Prints an error, its text made printable: a file name in it may hold any bytes.
int complain_of(const std::exception& error) noexcept {
  try {
    return complain(pillarfield::printable(error.what()).c_str());
  } catch (...) {
    return complain("out of memory");
  }
}

int run(int argc, char** argv) {
  pillarfield::viewer::Options options;
  if (const auto status = pillarfield::viewer::parse_options(argc, argv, options)) return *status;
  pillarfield::catch_interrupts();
  if (!options.headless) return pillarfield::viewer::run_window(options);
  pillarfield::viewer::run_headless(options);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    return complain("out of memory; take a smaller patch, or fewer frames");
  } catch (const std::exception& error) {
    if (pillarfield::viewer::is_device_lost(error)) {
      return complain("the graphics device was lost; start again, or choose another with --gpu");
    }
    return complain_of(error);
  } catch (...) {
    return complain("an unknown failure; please report it");
  }
}
