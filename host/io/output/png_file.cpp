#include "pillarfield/png_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <png.h>
#include <unistd.h>

#include <cstdio>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

[[noreturn]] void fail_to_write_png(const std::filesystem::path& path, const char* reason) {
  throw Error(path.string(), fmt::format("cannot be written: {}", reason),
              "check the directory and the free disk space");
}

/// A stream on a duplicate of the file descriptor.
std::FILE* stream_of(const OutputFile& file) {
  const int duplicate = fcntl(file.descriptor(), F_DUPFD_CLOEXEC, 0);
  return duplicate < 0 ? nullptr : fdopen(duplicate, "wb");
}

}  // namespace

void write_png(const std::filesystem::path& path, const RgbPicture& picture, Replace replace) {
  if (picture.rgb.empty() ||
      picture.rgb.size() != std::size_t{3} * picture.width * picture.height) {
    throw Error(path.string(), "the picture has no pixels", "set a size above 0");
  }
  OutputFile file(path, OutputKind::png, replace);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = picture.width;
  image.height = picture.height;
  image.format = PNG_FORMAT_RGB;
  std::FILE* const stream = stream_of(file);
  if (stream == nullptr) fail_to_write_png(path, "there are too many open files");
  const bool written =
      png_image_write_to_stdio(&image, stream, 0, picture.rgb.data(), 0, nullptr) != 0;
  const bool closed = std::fclose(stream) == 0;
  if (!written) fail_to_write_png(path, image.message);
  if (!closed) fail_to_write_png(path, "the disk is full");
  file.commit();
}

}  // namespace pillarfield
