#pragma once

#include <png.h>

#include <filesystem>
#include <stdexcept>

#include "viewer/render/target.h"

namespace pillarfield::viewer {

/// Reads a PNG; throws where that fails.
inline Pixels read_png(const std::filesystem::path& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&image, path.c_str()) == 0) {
    throw std::runtime_error(path.string() + ": " + &image.message[0]);
  }
  image.format = PNG_FORMAT_RGBA;
  Pixels pixels{image.width, image.height, {}};
  pixels.rgba.resize(PNG_IMAGE_SIZE(image));
  if (png_image_finish_read(&image, nullptr, pixels.rgba.data(), 0, nullptr) == 0) {
    throw std::runtime_error(path.string() + ": " + &image.message[0]);
  }
  return pixels;
}

}  // namespace pillarfield::viewer
