#include "viewer/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "pillarfield/error.h"
#include "pillarfield/live.h"
#include "pillarfield/skin.h"
#include "pillarfield/tare.h"
#include "pillarfield/version.h"

namespace pillarfield::viewer {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

constexpr const char* kFooter = R"(
SOURCE is a scene (.toml), a recording or a Tekscan ASCII export, which are solved while you watch;
a file of force fields from `pillarfield solve`; or a sensor: udp:ADDRESS:PORT, shm:NAME,
serial:DEVICE, or - for standard input. Keys and mouse: press ? in the window.

Try:  pillarfield-viewer scenes/demo.toml
      pillarfield-viewer scenes/sliding.toml --headless --frame 20 --png sliding.png
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

std::string quantity_names() {
  std::string names;
  for (int i = 0; i < kQuantities; ++i) {
    names += fmt::format("{}{}", i == 0 ? "" : ", ", info_of(static_cast<Quantity>(i)).name);
  }
  return names;
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

void take_layer(Options& options, const std::string& text) {
  const auto quantity = quantity_named(text);
  require(quantity.has_value(),
          fmt::format("'{}' is not a layer; choose {}", text, quantity_names()));
  options.quantity = *quantity;
}

void take_map(Options& options, const std::string& text) {
  for (int i = 0; i < kColourMaps; ++i) {
    if (text == name_of(static_cast<ColourMap>(i))) options.map = static_cast<ColourMap>(i);
  }
  require(
      options.map.has_value(),
      fmt::format("'{}' is not a colour map; choose cividis, viridis, diverging or cyclic", text));
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
  const SurfaceKind kind = name == "sphere" ? SurfaceKind::sphere : SurfaceKind::cylinder;
  options.surface = Surface{kind, radius[0]};
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

void take_fps(Options& options, const std::string& text) {
  options.fps = numbers(text, "", 1, "NUMBER")[0];
  require(*options.fps >= 0.1 && *options.fps <= 1000, "--fps must lie in [0.1, 1000]");
}

void take_speed(Options& options, const std::string& text) {
  options.speed = numbers(text, "", 1, "NUMBER")[0];
  require(options.speed >= 0.001 && options.speed <= 1000, "--speed must lie in [0.001, 1000]");
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

void take_zoom(Options& options, const std::string& text) {
  options.zoom = numbers(text, "", 1, "NUMBER")[0];
  require(options.zoom >= 0.05 && options.zoom <= 1000, "the zoom must lie in [0.05, 1000]");
}

void take_scale(Options& options, const std::string& text) {
  options.scale = numbers(text, "", 1, "NUMBER")[0];
  require(options.scale >= 0.5 && options.scale <= 4, "the scale must lie in [0.5, 4]");
}

void take_shape(Options& options, const std::string& text) {
  const auto shape = numbers(text, "x", 2, "ROWSxCOLS, in sensels");
  for (const double size : shape) {
    require(is_whole(size) && size >= 2 && size <= kMaxSensels,
            fmt::format("rows and columns must lie in [2, {}]", kMaxSensels));
  }
  options.plain.frame_size =
      FrameSize{static_cast<std::uint32_t>(shape[0]), static_cast<std::uint32_t>(shape[1])};
}

void take_axes(Options& options, const std::string& text) {
  try {
    options.plain.axes = parse_axes(text);
  } catch (const Error& error) {
    throw CLI::ValidationError(error.what());
  }
}

/// Adds what files of plain numbers leave open.
void add_plain_data(CLI::App& app, Options& options) {
  ReadOptions& plain = options.plain;
  const auto above = [](double least, double most) { return CLI::Range(least, most); };
  const auto group = [](CLI::Option* option) { option->group("Plain data"); };
  group(app.add_option("--dataset", plain.dataset, "Array of frames in an HDF5 file or .npz"));
  group(app.add_option("--times", plain.times, "Array of their times in that file, s"));
  group(app.add_option_function<std::string>(
      "--shape", [&](const std::string& text) { take_shape(options, text); },
      "Sensels of a frame whose readings lie in one line, ROWSxCOLS"));
  group(app.add_option_function<std::string>(
      "--axes", [&](const std::string& text) { take_axes(options, text); },
      "Order of the array's axes [frames,rows,columns]"));
  group(app.add_option("--rate", plain.rate_hz, "Frames per second, if the file has no times")
            ->check(above(1e-6, 1e9)));
  group(app.add_option("--pitch-mm", plain.sensel_pitch_mm, "Distance of neighbouring sensels")
            ->check(above(0.001, 1000)));
  group(
      app.add_option("--counts-per-newton", plain.counts_per_newton, "Counts per newton and pillar")
          ->check(above(kMinCountsPerNewton, kMaxCountsPerNewton)));
  group(app.add_option("--threshold", plain.threshold_counts, "Readings above this are usable")
            ->check(above(0, kMaxCounts)));
  group(app.add_option("--full-scale", plain.full_scale_counts,
                       "Readings of this or more are saturated")
            ->check(above(0, kMaxCounts)));
  group(app.add_option("--tare-frames", plain.tare_frames,
                       "Measure tare, noise and threshold in the first N frames, without load")
            ->check(CLI::Range(std::uint64_t{kLeastTareFrames}, std::uint64_t{1} << 32)));
}

void add_texts(CLI::App& app, Options& options) {
  const auto add = [&](const char* name, const char* help,
                       void (*take)(Options&, const std::string&)) {
    app.add_option_function<std::string>(
        name, [&options, take](const std::string& text) { take(options, text); }, help);
  };
  add("--size", "Size of the picture or the window, pixels [1280x720]", take_size);
  static const std::string layers = fmt::format("Quantity of the heat map: {}", quantity_names());
  add("--layer", layers.c_str(), take_layer);
  add("--range", "Ends of the colour bar, LOW:HIGH in the displayed unit [fitted to the source]",
      take_range);
  add("--map", "Colours: cividis, viridis, diverging or cyclic [by layer]", take_map);
  add("--view", "top, orbit or orbit:AZIMUTH,ELEVATION in degrees [top]", take_view);
  add("--surface", "In 3-D: plane, cylinder:RADIUS or sphere:RADIUS in mm [that of the source]",
      take_surface);
  add("--frames", "Render frames FIRST:LAST, counted from 1", take_frames);
  add("--fps", "Pictures a second of the video [rate of the source times --speed, at most 60]",
      take_fps);
  add("--speed", "Speed of the video: 0.1 is slow motion [1]", take_speed);
  add("--centre", "Centre of the top view, X,Y in mm [0,0]", take_centre);
  add("--zoom", "Zoom factor [1]", take_zoom);
  add("--scale", "Size of letters and lines [the display's, or 1]", take_scale);
}

void take_png(Options& options, const std::string& text) {
  options.png = text;
  std::string ending = options.png.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  require(ending == ".png", fmt::format("a picture must end in .png, unlike '{}'", text));
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
  require(options.beside.empty() || !options.truth,
          "a second source and --truth exclude each other");
  require(options.beside != "-", "only the first source can be standard input");
  require(!options.headless || (options.beside.empty() && !options.truth),
          "--headless draws one source, without --truth");
  require(!options.headless || !is_live_source(options.source.string()),
          "a sensor needs the window; record it with 'pillarfield stream --record' first");
  const bool may_be_sensor = options.source.empty() || is_live_source(options.source.string());
  require(options.calibration.empty() || may_be_sensor,
          "--calibration is that of a sensor; solve a recording with it: 'pillarfield solve "
          "--calibration', and show the forces");
  require(!options.headless || writes,
          "--headless needs something to write: --png, --video or --csv");
}

void add_view_flags(CLI::App& app, Options& options) {
  app.add_flag_callback(
      "--light", [&] { options.theme = Theme::light; }, "Dark on white");
  app.add_flag_callback(
      "--no-arrows", [&] { options.arrows = false; }, "No arrows");
  app.add_flag("--sectors,--fans", options.sectors,
               "Uncertainty sectors of ambiguous shear, at large zoom");
  app.add_flag_callback(
      "--no-hatch", [&] { options.hatch = false; }, "No hatching of ambiguous pillars");
  app.add_flag("--contacts", options.contacts,
               "Mark contacts: extent, id, force, centre of pressure, shear");
  app.add_flag("--relief", options.relief, "In 3-D, raise the surface by the normal force");
  app.add_flag_callback(
      "--no-legend", [&] { options.legend = false; },
      "Only the field, without axes and colour bar");
}

void add_files(CLI::App& app, Options& options) {
  app.add_flag("--headless", options.headless, "Write files without a window")->group("Files");
  app.add_option_function<std::string>(
         "--png", [&](const std::string& text) { take_png(options, text); },
         "Picture to write; NAME_001.png and so on for several frames")
      ->group("Files");
  app.add_option("--video", options.video, "Video to write with ffmpeg, .mp4 or .webm")
      ->group("Files");
  app.add_option("--csv", options.csv, "Table to write: visible forces of the first frame")
      ->group("Files");
  app.add_flag("--overwrite", options.overwrite,
               "Replace existing files of any kind, but never the source")
      ->group("Files");
}

void add_devices(CLI::App& app, Options& options) {
  app.add_option("--device", options.device, "OpenCL device that solves [the best]")
      ->group("Devices");
  app.add_option("--gpu", options.gpu, "Vulkan device that draws, by a part of its name [the best]")
      ->group("Devices");
  app.add_flag("--copy", options.copy_fields, "Always copy fields to the Vulkan device")
      ->group("Devices");
  app.add_flag("--validate", options.validate, "Enable the Vulkan validation layer")
      ->group("Devices");
  app.add_flag("--paused", options.paused, "Start paused")->group("Window");
  app.add_flag("--statistics", options.statistics, "Print rates and times as JSON at the end")
      ->group("Window");
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
  app.add_option("beside", options.beside, "A second source, shown beside the first");
  app.add_flag("--truth", options.truth,
               "Show the true forces of a simulation beside those solved");
  app.add_option("--calibration", options.calibration, "Calibration file of a live sensor")
      ->check(CLI::ExistingFile);
  app.add_flag("--trust-input", options.trust_input,
               "Read HDF5 files without probing them in a separate process first");
  add_texts(app, options);
  add_plain_data(app, options);
  std::uint64_t frame = 1;
  auto* const one =
      app.add_option("--frame", frame,
                     "Frame to show first, counted from 1 [1; headless: the most loaded]")
          ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 50));
  add_view_flags(app, options);
  add_files(app, options);
  add_devices(app, options);
  try {
    app.parse(argc, argv);
    check_together(options, one->count() > 0, options.end_frame != 0);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (one->count() > 0) options.first_frame = frame - 1;
  options.has_frame = one->count() > 0 || options.end_frame != 0;
  return std::nullopt;
}

}  // namespace pillarfield::viewer
