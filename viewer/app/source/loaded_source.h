#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "viewer/options.h"
#include "viewer/source/player.h"
#include "viewer/source/survey.h"

namespace pillarfield::viewer {

/// The source on display, and a second one beside.
struct ShownSource {
  std::string name;                  ///< as given: a path, or a live source
  std::shared_ptr<Curves> curves;    ///< of the first source
  std::unique_ptr<Survey> survey;    ///< fills `curves`; null for a sensor
  FieldProducer::Opener open_truth;  ///< empty where the truth is not known
  std::unique_ptr<Player> player;    ///< null: no source is open
  std::unique_ptr<Player> beside;    ///< a second source or the truth, at the right; null: none
  bool beside_is_truth = false;
  std::optional<ShownField> field;         ///< on display
  std::optional<ShownField> beside_field;  ///< of the second source

  /// True where the second source shows this frame, or its last; without one, and for a sensor.
  [[nodiscard]] bool is_in_step(std::uint64_t index) const;
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

/// Opens Options::source, and Options::beside or the truth where they are asked for. Throws Error.
[[nodiscard]] LoadedSource load_source(const Options& options, double scale,
                                       const LoadProgress& tell);

/// Opens the truth of the source `name`. Throws Error where it is not known.
[[nodiscard]] std::unique_ptr<FieldProducer> opened_truth(const FieldProducer::Opener& open_truth,
                                                          const std::string& name);

/// Opens the truth of a source beside it.
void show_truth(ShownSource& source);

/// Warnings of a source, as lines for standard error.
[[nodiscard]] std::string warning_lines(const SourceInfo& info);

}  // namespace pillarfield::viewer
