#include <fmt/format.h>
#include <png.h>

#include "pillarfield/error.h"
#include "viewer/app/export.h"
#include "viewer/app/unfinished_file.h"

namespace pillarfield::viewer {
namespace {

std::vector<std::uint8_t> without_alpha(const Pixels& pixels) {
  const std::size_t count = pixels.rgba.size() / 4;
  std::vector<std::uint8_t> rgb(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      rgb[3 * i + channel] = pixels.rgba[4 * i + channel];
    }
  }
  return rgb;
}

}  // namespace

void write_png(const std::filesystem::path& path, const Pixels& pixels) {
  if (pixels.rgba.empty() || pixels.rgba.size() != std::size_t{4} * pixels.width * pixels.height) {
    throw Error(path.string(), "there is no picture to be written", "give it a size");
  }
  UnfinishedFile file(path);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = pixels.width;
  image.height = pixels.height;
  image.format = PNG_FORMAT_RGB;
  const std::vector<std::uint8_t> rgb = without_alpha(pixels);
  if (png_image_write_to_file(&image, file.path().c_str(), 0, rgb.data(), 0, nullptr) == 0) {
    throw Error(path.string(), fmt::format("cannot be written: {}", image.message),
                "check its directory and the space left on its disk");
  }
  file.commit();
}

std::filesystem::path numbered(const std::filesystem::path& path, std::uint64_t frame,
                               std::uint64_t frames) {
  const std::size_t digits = std::to_string(frames).size();
  const std::string name =
      fmt::format("{}_{:0{}}{}", path.stem().string(), frame, digits, path.extension().string());
  return path.parent_path() / name;
}

}  // namespace pillarfield::viewer
