#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstring>

#include "pillarfield/error.h"
#include "simulation/indenter/height_map.h"

namespace pillarfield {
namespace {

/// The input of libpng and its error message.
struct PngInput {
  const std::byte* rest;
  std::size_t left;
  std::array<char, 80> message;
};

void read_png_bytes(png_structp png, png_bytep to, std::size_t count) {
  auto* const input = static_cast<PngInput*>(png_get_io_ptr(png));
  if (count > input->left) png_error(png, "it ends too early");
  std::memcpy(to, input->rest, count);
  input->rest += count;
  input->left -= count;
}

[[noreturn]] void note_png_error(png_structp png, png_const_charp message) {
  auto* const input = static_cast<PngInput*>(png_get_error_ptr(png));
  const std::size_t length = std::min(std::strlen(message), input->message.size() - 1);
  std::memcpy(input->message.data(), message, length);
  png_longjmp(png, 1);
}

void ignore_png_warning(png_structp, png_const_charp) {}

/// The decoded image. It outlives every longjmp() out of libpng.
struct PngPicture {
  png_structp png = nullptr;
  png_infop info = nullptr;
  png_uint_32 width = 0;
  png_uint_32 height = 0;
  int bits = 0;
  int colour = -1;
  std::vector<png_byte> samples;
  std::vector<png_bytep> rows;

  PngPicture() = default;
  PngPicture(const PngPicture&) = delete;
  PngPicture& operator=(const PngPicture&) = delete;
  ~PngPicture() { png_destroy_read_struct(&png, &info, nullptr); }
};

// libpng reports errors by longjmp(): the two functions below own no resources.

bool read_png_header(PngPicture& picture) {
  if (setjmp(png_jmpbuf(picture.png)) != 0) return false;
  png_read_info(picture.png, picture.info);
  png_get_IHDR(picture.png, picture.info, &picture.width, &picture.height, &picture.bits,
               &picture.colour, nullptr, nullptr, nullptr);
  return true;
}

bool read_png_samples(PngPicture& picture) {
  if (setjmp(png_jmpbuf(picture.png)) != 0) return false;
  png_set_interlace_handling(picture.png);
  png_read_update_info(picture.png, picture.info);
  png_read_image(picture.png, picture.rows.data());
  png_read_end(picture.png, nullptr);
  return true;
}

void check_png(const PngPicture& picture, const std::string& name) {
  if (picture.colour != PNG_COLOR_TYPE_GRAY || (picture.bits != 8 && picture.bits != 16)) {
    throw Error(name, "the picture is not grey of 8 or 16 bits", "convert it to that");
  }
  if (picture.width < 2 || picture.height < 2) {
    throw Error(name, fmt::format("the picture has {} x {} pixels", picture.width, picture.height),
                "a height map has 2 x 2 at least");
  }
}

}  // namespace

HeightMap parse_png(const std::vector<std::byte>& bytes, const std::string& name) {
  PngInput input = {bytes.data(), bytes.size(), {}};
  PngPicture picture;
  const auto fail = [&] {
    throw Error(
        name, fmt::format("is not a readable picture: {}", input.message.data()),
        fmt::format("give a PNG of grey, 8 or 16 bits, up to {0} x {0}", kMaxHeightMapSide));
  };
  picture.png =
      png_create_read_struct(PNG_LIBPNG_VER_STRING, &input, note_png_error, ignore_png_warning);
  if (picture.png) picture.info = png_create_info_struct(picture.png);
  if (!picture.info) fail();
  png_set_user_limits(picture.png, kMaxHeightMapSide, kMaxHeightMapSide);
  png_set_chunk_malloc_max(picture.png, 1U << 20U);
  png_set_read_fn(picture.png, &input, read_png_bytes);
  if (!read_png_header(picture)) fail();
  check_png(picture, name);
  const std::size_t bytes_each = picture.bits == 16 ? 2 : 1;
  const std::size_t row_bytes = picture.width * bytes_each;
  picture.samples.resize(row_bytes * picture.height);
  for (std::size_t row = 0; row < picture.height; ++row) {
    picture.rows.push_back(&picture.samples[row * row_bytes]);
  }
  if (!read_png_samples(picture)) fail();
  std::vector<double> values(std::size_t{picture.width} * picture.height);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = bytes_each == 1 ? picture.samples[i]
                                : 256 * picture.samples[2 * i] + picture.samples[2 * i + 1];
  }
  return height_map_of(picture.height, picture.width, std::move(values), name);
}

}  // namespace pillarfield
