#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "pillarfield/output_file.h"
#include "viewer/render/target.h"
#include "viewer/source/selection.h"

namespace pillarfield::viewer {

// `replace` selects which existing files an output may replace.

/// Writes a PNG without alpha. On failure throws Error and leaves no partial file.
void write_png(const std::filesystem::path& path, const Pixels& pixels,
               Replace replace = Replace::results);

/// "field_012.png" for "field.png" and frame 12 of 100, counted from 1, so that names sort by
/// frame.
[[nodiscard]] std::filesystem::path numbered(const std::filesystem::path& path, std::uint64_t frame,
                                             std::uint64_t frames);

/// Writes the pillars of `rect` that are not idle as CSV, one line each, in the columns of
/// `pillarfield solve -o x.csv` (docs/formats.md).
void write_csv(const std::filesystem::path& path, const ShownField& field, const PillarRect& rect,
               Replace replace = Replace::results);

/// Encodes pictures of one size as a video by a child process ffmpeg. A failure throws Error with
/// ffmpeg's message.
class VideoWriter {
 public:
  /// Throws Error, with the Debian package, where ffmpeg is not installed.
  VideoWriter(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
              double rate_hz, Replace replace = Replace::results);
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;
  void add(const Pixels& pixels);
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield::viewer
