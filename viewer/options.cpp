#include "viewer/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "cli/options/shared_arguments.h"
#include "pillarfield/live.h"
#include "pillarfield/version.h"

namespace pillarfield::viewer {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

constexpr const char* kFooter = R"(
SOURCE is a scene (.toml), a recording or a Tekscan ASCII export, which are solved while you watch;
a file of force fields from `pillarfield solve`; or a sensor: udp:ADDRESS:PORT, shm:NAME,
serial:DEVICE (of a FlexiTac board 'serial:DEVICE?protocol=flexitac&rows=16&cols=32'), or - for
standard input. Keys and mouse: press ? in the window.

Try:  pillarfield-viewer scenes/demo.toml
      pillarfield-viewer scenes/touch/sliding.toml --headless --frame 20 --png sliding.png
      pillarfield-viewer forces.h5 --headless --frames 1:60 --size 1920x1080 --video touch.mp4)";

/// Parses the numbers of "1280x720", "-0.5:0.5" or "10,20"; the error shows the expected form.
std::vector<double> numbers(const std::string& text, const std::string& separators,
                            std::size_t count, const char* form) {
  std::vector<double> values;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
    const std::string part = text.substr(begin, end - begin);
    std::size_t used = 0;
    try {
      values.push_back(std::stod(part, &used));
    } catch (const std::exception&) {
      used = std::string::npos;
    }
    if (used != part.size() || !std::isfinite(values.back())) break;
    begin = end + 1;
  }
  if (begin <= text.size() || values.size() != count) {
    throw CLI::ValidationError(fmt::format("'{}' does not have the form {}", text, form));
  }
  return values;
}

void require(bool holds, const std::string& complaint) {
  if (!holds) throw CLI::ValidationError(complaint);
}

/// The words of an enumeration of `count` values.
template <class Value>
std::vector<std::pair<std::string, Value>> choices_of(int count,
                                                      const char* (*word_of)(Value value)) {
  std::vector<std::pair<std::string, Value>> choices;
  choices.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    choices.emplace_back(word_of(static_cast<Value>(i)), static_cast<Value>(i));
  }
  return choices;
}

bool is_whole(double value) { return value == std::floor(value); }

void take_size(Options& options, const std::string& text) {
  const auto size = numbers(text, "x", 2, "WIDTHxHEIGHT, in pixels");
  require(is_whole(size[0]) && is_whole(size[1]) && size[0] >= 320 && size[0] <= 8192 &&
              size[1] >= 240 && size[1] <= 8192,
          "the size must lie between 320x240 and 8192x8192 pixels");
  options.width = static_cast<std::uint32_t>(size[0]);
  options.height = static_cast<std::uint32_t>(size[1]);
}

void take_view(Options& options, const std::string& text) {
  const std::string name = text.substr(0, text.find(':'));
  require(name == "top" || name == "orbit",
          fmt::format("'{}' is not a view; choose top, orbit or orbit:AZIMUTH,ELEVATION", text));
  options.orbit = name == "orbit";
  if (text == name) return;
  require(options.orbit, "a top view has no angles");
  const auto angles = numbers(text.substr(name.size() + 1), ",", 2, "orbit:AZIMUTH,ELEVATION");
  require(angles[1] > 0 && angles[1] <= 90, "the elevation must lie in (0, 90] degrees");
  options.azimuth = angles[0] * kDegree;
  options.elevation = angles[1] * kDegree;
}

void take_surface(Options& options, const std::string& text) {
  options.surface = Surface{};
  if (text == "plane") return;
  const std::string name = text.substr(0, text.find(':'));
  require(
      (name == "cylinder" || name == "sphere") && text != name,
      fmt::format("'{}' is not a surface; choose plane, cylinder:RADIUS or sphere:RADIUS, in mm",
                  text));
  const auto radius =
      numbers(text.substr(name.size() + 1), ",", 1, "cylinder:RADIUS or sphere:RADIUS, in mm");
  require(radius[0] >= 1 && radius[0] <= 1e5, "the radius must lie in [1, 100000] mm");
  options.surface->shape = name == "sphere" ? SurfaceShape::sphere : SurfaceShape::cylinder;
  options.surface->radius_mm = radius[0];
}

/// The command line counts frames from 1.
void take_frames(Options& options, const std::string& text) {
  const auto frames = numbers(text, ":", 2, "FIRST:LAST, counted from 1");
  require(is_whole(frames[0]) && is_whole(frames[1]) && frames[0] >= 1 && frames[1] >= frames[0] &&
              frames[1] < 1e15,
          "frames count from 1, and LAST must not be below FIRST");
  options.first_frame = static_cast<std::uint64_t>(frames[0]) - 1;
  options.end_frame = static_cast<std::uint64_t>(frames[1]);
}

void take_range(Options& options, const std::string& text) {
  const auto ends = numbers(text, ":", 2, "LOW:HIGH");
  constexpr double kMost = 1e30;  // Well within single precision.
  require(ends[0] < ends[1] && ends[0] >= -kMost && ends[1] <= kMost,
          "LOW must be below HIGH, both in [-1e30, 1e30]");
  options.range = Range{static_cast<float>(ends[0]), static_cast<float>(ends[1])};
}

void take_centre(Options& options, const std::string& text) {
  constexpr double kMostMm = 1e6;  // Axes lack digits beyond.
  const auto point = numbers(text, ",", 2, "X,Y, in mm");
  require(std::abs(point[0]) <= kMostMm && std::abs(point[1]) <= kMostMm,
          "the centre must lie within 1e6 mm of the middle of the skin");
  options.centre_mm = Vec2{point[0], point[1]};
}

void add_picture(CLI::App& app, Options& options) {
  const auto add = [&](const char* name, const char* form, const char* help,
                       void (*take)(Options&, const std::string&)) {
    app.add_option_function<std::string>(
           name, [&options, take](const std::string& text) { take(options, text); }, help)
        ->type_name(form)
        ->group("Picture");
  };
  cli::Group picture(&app, "Picture");
  add("--size", "WIDTHxHEIGHT", "Size of the picture or the window, pixels [1280x720]", take_size);
  picture.choice<Quantity>(
      "--layer", options.look.quantity,
      choices_of<Quantity>(kQuantities, [](Quantity each) { return info_of(each).name; }),
      "Quantity of the heat map [normal]");
  cli::add_pressure_unit(picture, options.look.units.pressure);
  add("--range", "LOW:HIGH", "Ends of the colour bar in the displayed unit [fitted to the source]",
      take_range);
  picture.choice<ColourMap>("--map", options.map, choices_of<ColourMap>(kColourMaps, name_of),
                            "Colours [by layer]");
  add("--view", "VIEW", "top, orbit or orbit:AZIMUTH,ELEVATION in degrees [top]", take_view);
  add("--surface", "SURFACE",
      "In 3-D: plane, cylinder:RADIUS or sphere:RADIUS in mm [that of the source]", take_surface);
  add("--centre", "X,Y", "Centre of the top view, mm [0,0]", take_centre);
  picture.number("--zoom", options.zoom, "FACTOR", "Zoom factor [1]", 0.05, 1000);
  picture.number("--scale", options.scale, "FACTOR",
                 "Size of letters and lines [the display's, or 1]", 0.5, 4);
}

void check_together(const Options& options, bool has_frame, bool has_frames) {
  const bool writes = !options.png.empty() || !options.video.empty() || !options.csv.empty();
  require(!(has_frame && has_frames), "--frame and --frames exclude each other");
  require(options.headless || !has_frames, "--frames needs --headless");
  require(options.headless || !writes,
          "--png, --video and --csv need --headless; the window has keys for them");
  require(!options.video.empty() || (!options.fps && options.speed == 1),
          "--fps and --speed need --video");
  require(!options.headless || !options.source.empty(), "--headless needs a source");
  require(!options.headless || !is_live_source(options.source.string()),
          "a sensor needs the window; record it with 'pillarfield stream --record' first");
  require(!options.headless || writes,
          "--headless needs something to write: --png, --video or --csv");
}

void add_layers(CLI::App& app, Options& options) {
  const auto clear = [&](const char* name, bool& shown, const char* help) {
    app.add_flag_callback(
           name, [&shown] { shown = false; }, help)
        ->group("Layers");
  };
  cli::Group layers(&app, "Layers");
  app.add_flag_callback(
         "--light", [&] { options.look.theme = Theme::light; }, "Dark on white")
      ->group("Layers");
  clear("--no-arrows", options.look.arrows, "No arrows");
  layers.flag("--sectors,--fans", options.look.sectors,
              "Uncertainty sectors of ambiguous shear, at large zoom");
  clear("--no-hatch", options.look.hatch, "No hatching of ambiguous pillars");
  clear("--no-contacts", options.look.contacts,
        "No marks of contacts: extent, id, force, centre of pressure, shear");
  app.add_flag("--contacts")->group("");  // for old command lines; the default
  layers.flag("--relief", options.look.relief, "In 3-D, raise the surface by the normal force");
  clear("--no-legend", options.look.legend, "Only the field, without axes and colour bar");
}

CLI::Validator png_name() {
  return {[](const std::string& text) -> std::string {
            return CLI::detail::to_lower(std::filesystem::path(text).extension()) == ".png"
                       ? ""
                       : fmt::format("a picture must end in .png, unlike '{}'", text);
          },
          ""};
}

void add_files(CLI::App& app, Options& options) {
  cli::Group files(&app, "Files");
  files.flag("--headless", options.headless, "Write files without a window");
  files
      .text("--png", options.png, "FILE",
            "Picture to write, its folder too; NAME_001.png and so on for several frames")
      ->check(png_name());
  files.text("--video", options.video, "FILE", "Video to write with ffmpeg, .mp4 or .webm");
  files.text("--csv", options.csv, "FILE", "Table to write: visible forces of the first frame");
  files.flag("--overwrite", options.overwrite,
             "Replace existing files of any kind, but never the source");
  app.add_option_function<std::string>(
         "--frames", [&](const std::string& text) { take_frames(options, text); },
         "Render these frames, counted from 1")
      ->type_name("FIRST:LAST")
      ->group("Files");
  files.number("--fps", options.fps, "HZ",
               "Pictures a second of the video [rate of the source times --speed, at most 60]", 0.1,
               1000);
  files.number("--speed", options.speed, "FACTOR", "Speed of the video: 0.1 is slow motion [1]",
               0.001, 1000);
}

void add_devices(CLI::App& app, Options& options) {
  cli::Group devices(&app, "Devices");
  devices.text("--device", options.device, "DEVICE",
               "Device that solves: host, opencl, or one of OpenCL [host for small skins]");
  devices.text("--gpu", options.gpu, "DEVICE",
               "Vulkan device that draws, by a part of its name [the best]");
  devices.flag("--copy", options.copy_fields, "Always copy fields to the Vulkan device");
  devices.flag("--validate", options.validate, "Enable the Vulkan validation layer");
  cli::Group window(&app, "Window");
  window.flag("--paused", options.paused, "Start paused");
  window.flag("--statistics", options.statistics, "Print rates and times as JSON at the end");
}

}  // namespace

std::optional<int> parse_options(int argc, char** argv, Options& options) {
  CLI::App app("Shows fields of three-axis force, in a window or as pictures in files.",
               "pillarfield-viewer");
  app.set_version_flag("--version", kVersion, "Print the version and exit");
  app.footer(kFooter);
  app.add_option(
      "source", options.source,
      "Scene, recording, Tekscan export, plain data, force fields or live source [start page]");
  app.add_option("--calibration", options.calibration, "Calibration file of a recording or sensor")
      ->type_name("FILE")
      ->check(CLI::ExistingFile)
      ->group("Input");
  cli::add_trust(&app, options.plain);
  cli::add_tare_frames(&app, options.plain);
  std::uint64_t frame = 1;
  auto* const one = cli::Group(&app, "Input")
                        .whole("--frame", frame, "N",
                               "Frame to show first, counted from 1 [1; headless: the most loaded]",
                               1, std::uint64_t{1} << 50);
  cli::add_plain_data(&app, options.plain, true);
  cli::add_shown_settings(&app, options.settings);
  add_picture(app, options);
  add_layers(app, options);
  add_files(app, options);
  add_devices(app, options);
  try {
    app.parse(argc, argv);
    check_together(options, one->count() > 0, options.end_frame != 0);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    fmt::print(stderr, "{0}: {1}\n", app.get_name(), cli::complaint_of(app, error, app.get_name()));
    return 2;
  }
  if (one->count() > 0) options.first_frame = frame - 1;
  options.has_frame = one->count() > 0 || options.end_frame != 0;
  return std::nullopt;
}

}  // namespace pillarfield::viewer
