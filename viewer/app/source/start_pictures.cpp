#include "viewer/app/source/start_pictures.h"

#include <png.h>

#include <algorithm>
#include <cmath>

#include "pillarfield/error.h"

namespace pillarfield::viewer {
namespace {

Pixels decoded(const EmbeddedPicture& picture) {
  const std::span<const unsigned char> png = picture.png;
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  Pixels pixels;
  if (png_image_begin_read_from_memory(&image, png.data(), png.size()) != 0) {
    image.format = PNG_FORMAT_RGBA;
    pixels = {image.width, image.height, std::vector<std::uint8_t>(PNG_IMAGE_SIZE(image))};
    if (png_image_finish_read(&image, nullptr, pixels.rgba.data(), 0, nullptr) != 0) return pixels;
  }
  throw Error(std::string(picture.scene), &image.message[0], "build the viewer again");
}

/// Each pixel is the mean of those that it stands for.
Pixels shrunk(const Pixels& whole, std::uint32_t width) {
  if (width >= whole.width) return whole;
  const double step = static_cast<double>(whole.width) / width;
  const auto height = static_cast<std::uint32_t>(std::floor(whole.height / step));
  Pixels small{width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height)};
  const auto begin = [&](std::uint32_t at) { return static_cast<std::uint32_t>(at * step); };
  for (std::uint32_t row = 0; row < height; ++row) {
    for (std::uint32_t i = 0; i < 4 * width; ++i) {
      const std::uint32_t col = i / 4;
      unsigned sum = 0;
      unsigned count = 0;
      for (std::uint32_t y = begin(row); y < begin(row + 1); ++y) {
        for (std::uint32_t x = begin(col); x < begin(col + 1); ++x, ++count) {
          sum += whole.rgba[4 * (std::size_t{y} * whole.width + x) + i % 4];
        }
      }
      small.rgba[4 * std::size_t{row} * width + i] = static_cast<std::uint8_t>(sum / count);
    }
  }
  return small;
}

}  // namespace

std::vector<Pixels> start_pictures(double scale) {
  std::vector<Pixels> pictures;
  for (const EmbeddedPicture& picture : embedded_pictures()) {
    pictures.push_back(
        shrunk(decoded(picture), static_cast<std::uint32_t>(kStartPictureWidth * scale)));
  }
  return pictures;
}

}  // namespace pillarfield::viewer
