#pragma once

#include "viewer/options.h"

namespace pillarfield::viewer {

/// Shows a source in a window until it is closed; the exit status.
[[nodiscard]] int run_window(const Options& options);

}  // namespace pillarfield::viewer
