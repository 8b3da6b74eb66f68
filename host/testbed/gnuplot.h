#pragma once

#include <filesystem>
#include <string>

#include "pillarfield/output_file.h"

namespace pillarfield::gnuplot {

/// Of a figure in the pixels that its SVG names; the PNG has twice as many each way.
struct Size {
  int width_px = 720;
  int height_px = 480;
};

/// Draws a script of gnuplot as `stem`.svg and `stem`.png, both or neither; of what bears these
/// names, `replace` says what is replaced at the end. `stem` is a path without an ending, in a
/// folder that exists.
///
/// The script says neither terminal nor output. It begins in the style of this project: UTF-8,
/// enhanced text, tics outside, no box, and linetypes 1 to 8 in the colours of Okabe and Ito, which
/// colour-blind readers tell apart:
///
///     1 black  2 orange  3 sky blue  4 bluish green  5 yellow  6 blue  7 vermilion  8 purple
///
/// Data go into the script as data blocks. Throws Error where gnuplot is not installed, fails or
/// skips data, or where the files cannot be written. Takes some 0.1 s.
void draw(const std::filesystem::path& stem, const std::string& script, Size size = {},
          Replace replace = Replace::results);

}  // namespace pillarfield::gnuplot
