#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "viewer/style/render_settings.h"

namespace pillarfield::viewer {

/// The command line.
struct Options {
  std::filesystem::path source;
  bool trust_input = false;
  std::string device;  ///< of OpenCL, for solving
  std::string gpu;     ///< of Vulkan, for drawing
  std::uint32_t width = 1280;
  std::uint32_t height = 720;
  double scale = 0;          ///< 0: that of the display; 1 without one
  bool copy_fields = false;  ///< fields are copied to the graphics device even where it could read
                             ///< them in place
  bool validate = false;
  bool headless = false;
  bool paused = false;
  bool statistics = false;  ///< printed when the window is closed

  Quantity quantity = Quantity::normal;
  std::optional<Range> range;  ///< unset: what fits the source
  std::optional<ColourMap> map;
  Theme theme = Theme::dark;
  bool orbit = false;
  std::optional<double> azimuth;    ///< rad
  std::optional<double> elevation;  ///< rad
  double zoom = 1;
  std::optional<Vec2> centre_mm;
  Surface surface;
  bool arrows = true;
  bool sectors = false;
  bool hatch = true;
  bool contacts = false;
  bool legend = true;

  std::filesystem::path png;
  std::filesystem::path video;
  std::filesystem::path csv;
  bool overwrite = false;
  std::uint64_t first_frame = 0;  ///< first shown; of --frame and --frames
  std::uint64_t end_frame = 0;    ///< after the last one rendered; 0: first_frame + 1
};

/// Parses; on --help and --version prints them. Returns the exit status where the program is to
/// end, else nothing.
[[nodiscard]] std::optional<int> parse_options(int argc, char** argv, Options& options);

/// How the first picture looks: what the options say, and what fits the source for the rest; its
/// view is not set. A few frames, evenly spread, are produced for that. Throws Error where the
/// source has not what is to be shown.
[[nodiscard]] RenderSettings default_settings(const Options& options, FieldProducer& producer,
                                              double scale);

/// Ends of the colour bar that fit what a few frames, evenly spread, hold of a quantity.
[[nodiscard]] Range range_that_fits(FieldProducer& producer, Quantity quantity);

/// From where it is seen first, in the plot of a picture's layout.
[[nodiscard]] View first_view(const Options& options, const SourceInfo& source,
                              const Viewport& plot);

}  // namespace pillarfield::viewer
