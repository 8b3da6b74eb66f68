#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "pillarfield/output_file.h"
#include "viewer/render/target.h"
#include "viewer/source/selection.h"

namespace pillarfield::viewer {

// Of what bears the name of an output, `replace` says what is replaced.

/// Writes a PNG, without its alpha. Throws Error where that fails; nothing half-written stays.
void write_png(const std::filesystem::path& path, const Pixels& pixels,
               Replace replace = Replace::results);

/// "field.png" and frame 12 of 100, counted from 1 as people see it, becomes "field_012.png": names
/// of a sequence sort by frame.
[[nodiscard]] std::filesystem::path numbered(const std::filesystem::path& path, std::uint64_t frame,
                                             std::uint64_t frames);

/// Pillars of `rect` as CSV, one line each that is not idle, columns as `pillarfield solve -o
/// x.csv` has them (docs/formats.md).
void write_csv(const std::filesystem::path& path, const ShownField& field, const PillarRect& rect,
               Replace replace = Replace::results);

/// Pictures of one size that become a video, through a child process ffmpeg. A picture that fails
/// to be taken ends in an Error with what ffmpeg said.
class VideoWriter {
 public:
  /// Throws Error where ffmpeg is not installed, names the Debian package.
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
