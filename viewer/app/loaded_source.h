#pragma once

#include <memory>

#include "viewer/app/app_state.h"
#include "viewer/options.h"

namespace pillarfield::viewer {

/// A source that is ready to be played, and how it looks first; the view is not set.
struct LoadedSource {
  std::unique_ptr<Player> player;
  RenderSettings settings;
};

/// How the source is opened; that kernels are compiled is said on standard error where that is a
/// terminal.
[[nodiscard]] ProducerOptions producer_options(const Options& options);

/// Opens the source of the options; on a terminal, tells how far a scene is simulated. Warnings of
/// the source go to standard error. Throws Error.
[[nodiscard]] LoadedSource load_source(const Options& options, double scale);

}  // namespace pillarfield::viewer
