#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "viewer/render/target.h"

namespace pillarfield::viewer {

/// A picture of docs/pictures/gallery, which the program holds as PNG.
struct EmbeddedPicture {
  std::string_view scene;  ///< name of its file, without extension
  std::span<const unsigned char> png;
};

/// The pictures of the start page, of equal size; that of the demo is the first.
[[nodiscard]] std::span<const EmbeddedPicture> embedded_pictures();

/// Width of a picture of the start page, nominal pixels; it is 3 : 2.
inline constexpr double kStartPictureWidth = 206;

/// The pictures of the start page at a scale, at most in their own size. Throws Error.
[[nodiscard]] std::vector<Pixels> start_pictures(double scale);

}  // namespace pillarfield::viewer
