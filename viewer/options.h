#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "pillarfield/plan_builder.h"
#include "viewer/style/render_settings.h"

namespace pillarfield::viewer {

/// The command line.
struct Options {
  std::filesystem::path source;       ///< a file, or a live source; empty: the start page
  std::filesystem::path calibration;  ///< of recordings and sensors
  ReadOptions plain;      ///< of plain data: array, times, size of a frame, rate, layout, tare
  PlanSettings settings;  ///< those of the command line that the viewer has, too
  std::string device;     ///< OpenCL device that solves
  std::string gpu;        ///< Vulkan device that draws
  std::uint32_t width = 1280;
  std::uint32_t height = 720;
  double scale = 0;          ///< 0: the display's scale, 1 without a display
  bool copy_fields = false;  ///< copy fields even where the graphics device could import them
  bool validate = false;
  bool headless = false;
  bool paused = false;
  bool statistics = false;  ///< printed when the window closes

  RenderSettings look;         ///< but for what is fitted to the source, and for the next members
  std::optional<Range> range;  ///< in the displayed unit; unset: fitted to the source
  std::optional<ColourMap> map;
  std::optional<Surface> surface;  ///< unset: that of the source
  bool orbit = false;
  std::optional<double> azimuth;    ///< rad
  std::optional<double> elevation;  ///< rad
  double zoom = 1;
  std::optional<Vec2> centre_mm;

  std::filesystem::path png;
  std::filesystem::path video;
  std::filesystem::path csv;
  bool overwrite = false;
  bool has_frame = false;         ///< first_frame was given
  std::optional<double> fps;      ///< pictures a second of the video; unset: rate times speed
  double speed = 1;               ///< of the video, relative to the source
  std::uint64_t first_frame = 0;  ///< first frame shown (--frame, --frames)
  std::uint64_t end_frame = 0;    ///< one past the last rendered frame; 0: first_frame + 1
};

/// Parses the command line; prints --help and --version. Returns the exit status if the program
/// must end.
[[nodiscard]] std::optional<int> parse_options(int argc, char** argv, Options& options);

/// Settings of a picture from the options, without what is fitted to a source: lengths of arrows,
/// the view, a range that is not given. Throws Error where the source lacks the quantity.
[[nodiscard]] RenderSettings chosen_settings(const Options& options, const SourceInfo& source,
                                             double scale);

/// Settings of the first picture from the options, with defaults fitted to up to 16 evenly spaced
/// frames; the view is not set. Throws Error where the source lacks the quantity.
[[nodiscard]] RenderSettings default_settings(const Options& options, FieldProducer& producer,
                                              double scale);

/// The frame with the largest total normal force of up to 64 evenly spaced ones.
[[nodiscard]] std::uint64_t most_loaded_frame(FieldProducer& producer);

/// Range of the colour bar fitted to up to 16 evenly spaced frames.
[[nodiscard]] Range range_that_fits(FieldProducer& producer, Quantity quantity);

/// Initial view of a picture.
[[nodiscard]] View first_view(const Options& options, const SourceInfo& source,
                              const Layout& layout);

}  // namespace pillarfield::viewer
