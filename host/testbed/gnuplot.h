#pragma once

#include <filesystem>
#include <string>

#include "pillarfield/output_file.h"

namespace pillarfield::gnuplot {

/// Pixels of the SVG; the PNG has twice as many in each direction.
struct Size {
  int width_px = 720;
  int height_px = 480;
};

/// Draws a script of gnuplot as `stem`.svg and `stem`.png, both or neither. `stem` is a path
/// without an ending in an existing folder.
///
/// The script sets neither terminal nor output. Its style is UTF-8, enhanced text, tics outside, no
/// box, and linetypes 1 to 8 in the colour-blind safe colours of Okabe and Ito:
///
///     1 black  2 orange  3 sky blue  4 bluish green  5 yellow  6 blue  7 vermilion  8 purple
///
/// Data are data blocks of the script. Throws Error where gnuplot is missing, fails or skips data,
/// or the files cannot be written. Takes about 0.1 s.
void draw(const std::filesystem::path& stem, const std::string& script, Size size = {},
          Replace replace = Replace::results);

}  // namespace pillarfield::gnuplot
