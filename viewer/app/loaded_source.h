#pragma once

#include <memory>

#include "viewer/app/app_state.h"
#include "viewer/options.h"

namespace pillarfield::viewer {

/// A source ready to play, with its initial settings; the view is not set.
struct LoadedSource {
  std::unique_ptr<Player> player;
  RenderSettings settings;
};

/// Options for opening the source; on a terminal, standard error reports kernel compilation.
[[nodiscard]] ProducerOptions producer_options(const Options& options);

/// Opens the source; shows simulation progress on a terminal and prints the source's warnings to
/// standard error. Throws Error.
[[nodiscard]] LoadedSource load_source(const Options& options, double scale);

}  // namespace pillarfield::viewer
