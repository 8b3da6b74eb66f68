#include <fcntl.h>
#include <fmt/format.h>
#include <png.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "pillarfield/error.h"
#include "pillarfield/force_file.h"
#include "pillarfield/solver_plan.h"
#include "viewer/app/export/export.h"

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

void write_png(const std::filesystem::path& path, const Pixels& pixels, Replace replace) {
  if (pixels.rgba.empty() || pixels.rgba.size() != std::size_t{4} * pixels.width * pixels.height) {
    throw Error(path.string(), "the picture has no pixels", "set a size above 0");
  }
  OutputFile file(path, OutputKind::png, replace);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = pixels.width;
  image.height = pixels.height;
  image.format = PNG_FORMAT_RGB;
  const std::vector<std::uint8_t> rgb = without_alpha(pixels);
  std::FILE* const stream = stream_of(file);
  if (stream == nullptr) fail_to_write_png(path, "there are too many open files");
  const bool written = png_image_write_to_stdio(&image, stream, 0, rgb.data(), 0, nullptr) != 0;
  const bool closed = std::fclose(stream) == 0;
  if (!written) fail_to_write_png(path, image.message);
  if (!closed) fail_to_write_png(path, "the disk is full");
  file.commit();
}

std::filesystem::path numbered(const std::filesystem::path& path, std::uint64_t frame,
                               std::uint64_t frames) {
  const std::size_t digits = std::to_string(frames).size();
  const std::string name =
      fmt::format("{}_{:0{}}{}", path.stem().string(), frame, digits, path.extension().string());
  return path.parent_path() / name;
}

void write_csv(const std::filesystem::path& path, const ShownField& field, const PillarRect& rect,
               Replace replace) {
  ForceFieldView forces = field.forces;
  ForceFileInfo info;
  info.layout = has_pillars(forces) ? SkinLayout::pillars : SkinLayout::sensels;
  info.rows = forces.rows;
  info.cols = forces.cols;
  info.angles = !forces.magnitude.empty();
  info.uncertainty = !forces.uncertainty[Uncertainty::normal].empty();
  if (field.direct_point) info.estimator = name_of(Estimator::direct);
  info.segment_point = field.direct_point;
  info.effects.shear_coefficient = field.shear_coefficient;
  // Pillars outside `rect` count as idle, which are omitted.
  std::vector<std::uint8_t> status(forces.status.size());
  const std::uint32_t col_end = std::min(rect.col_end, forces.cols);
  for (std::uint32_t row = rect.row_begin; row < std::min(rect.row_end, forces.rows); ++row) {
    const std::size_t first = std::size_t{row} * forces.cols;
    for (std::size_t at = first + rect.col_begin; at < first + col_end; ++at) {
      status[at] = forces.status[at];
    }
  }
  forces.status = status;
  write_force_csv(path, info, forces, field.index, field.time_s, replace);
}

}  // namespace pillarfield::viewer
