#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "viewer/options.h"
#include "viewer/source/player.h"
#include "viewer/source/survey.h"

namespace pillarfield::viewer {

/// The source on display.
struct ShownSource {
  std::string name;  ///< as given: a path, or a live source
  std::shared_ptr<Curves> curves;
  std::unique_ptr<Survey> survey;   ///< fills `curves`; null for a sensor
  std::unique_ptr<Player> player;   ///< null: no source is open
  std::optional<ShownField> field;  ///< on display
};

/// A source ready to play, with its initial settings; the view is not set.
struct LoadedSource {
  ShownSource source;
  RenderSettings settings;
};

/// Receives what the user waits for: "simulating 43 %". May throw to stop.
using LoadProgress = std::function<void(const std::string& words)>;

/// Options for opening a file; `tell` reports the compilation of kernels, from another thread.
[[nodiscard]] ProducerOptions producer_options(const Options& options, LoadProgress tell);

/// Opens Options::source. Throws Error.
[[nodiscard]] LoadedSource load_source(const Options& options, double scale,
                                       const LoadProgress& tell);

/// Warnings of a source, as lines for standard error.
[[nodiscard]] std::string warning_lines(const SourceInfo& info);

}  // namespace pillarfield::viewer
