#include "viewer/app/source/loaded_source.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"
#include "pillarfield/layout_note.h"
#include "pillarfield/printable.h"
#include "viewer/source/live_player.h"

namespace pillarfield::viewer {
namespace {

/// A sensor begins with a range that a user widens or fits; there are no frames to fit it to.
RenderSettings live_settings(const Options& options, const SourceInfo& source, double scale) {
  constexpr float kFirstRangeN = 1;
  RenderSettings settings = chosen_settings(options, source, scale);
  if (!options.range) settings.range = fitting_range(settings.quantity, kFirstRangeN);
  settings.full_force_n = settings.full_shear_n = static_cast<double>(kFirstRangeN) / 2;
  return settings;
}

LoadedSource load_sensor(const Options& options, const std::string& name, double scale,
                         const LoadProgress& tell) {
  LoadedSource loaded;
  loaded.source.name = name;
  std::string waiting = fmt::format("waiting for frames from {}", printable(name));
  tell(waiting);
  const auto stop = [&] {
    try {
      tell(waiting);
      return is_interrupted();
    } catch (const Error&) {
      return true;
    }
  };
  OpenedSensor opened =
      open_sensor(name, {.producer = producer_options(options, tell),
                         .stop = stop,
                         .say = [&](const std::string& words) { waiting += ": " + words; }});
  if (opened.player == nullptr) throw Error(name, "interrupted", "start again");
  const bool solves_here = opened.player->info().has_readings;
  const std::string note = assumption_note(opened.player->info().skin);
  if (solves_here && !note.empty()) {
    fmt::print(stderr, "pillarfield-viewer: {}: {}\n", printable(name), note);
  }
  loaded.source.curves = std::move(opened.curves);
  loaded.settings = live_settings(options, opened.player->info(), scale);
  loaded.source.player = std::move(opened.player);
  return loaded;
}

LoadedSource load_file(const Options& options, const std::filesystem::path& path, double scale,
                       const LoadProgress& tell) {
  auto producer = open_producer(path, producer_options(options, tell), [&](double share) {
    tell(fmt::format("simulating {:.0f} %", std::floor(100 * share)));
  });
  tell("looking at the forces");
  LoadedSource loaded;
  loaded.settings = default_settings(options, *producer, scale);
  ShownSource& source = loaded.source;
  source.name = path.string();
  source.curves = std::make_shared<Curves>(producer->info().skin.element_pitch_mm());
  source.survey = std::make_unique<Survey>(producer->open_again, source.curves);
  source.player = play_file(std::move(producer));
  return loaded;
}

}  // namespace

ProducerOptions producer_options(const Options& options, LoadProgress tell) {
  ProducerOptions wanted;
  wanted.device = options.device;
  wanted.plan = {.read = frame_options({.read = options.plain, .settings = options.settings}),
                 .calibration = options.calibration,
                 .settings = options.settings};
  if (!tell) return wanted;
  wanted.on_compiling = [tell = std::move(tell)](const std::string& line) {
    try {
      tell(line);
    } catch (const Error&) {
      // The next message stops the opening in its own thread.
    }
  };
  return wanted;
}

LoadedSource load_source(const Options& options, double scale, const LoadProgress& tell) {
  const std::filesystem::path& source = options.source;
  return is_live_source(source.string()) ? load_sensor(options, source.string(), scale, tell)
                                         : load_file(options, source, scale, tell);
}

std::string warning_lines(const SourceInfo& info) {
  std::string lines;
  const auto add = [&](const char* kind, const std::vector<std::string>& sentences) {
    for (const std::string& sentence : sentences) {
      lines += printable(fmt::format("pillarfield-viewer: {}: {}: {}", info.name, kind, sentence));
      lines += '\n';
    }
  };
  add("warning", info.warnings);
  add("note", info.notes);
  return lines;
}

}  // namespace pillarfield::viewer
