#pragma once

#include <filesystem>
#include <memory>

#include "viewer/app/app_state.h"
#include "viewer/app/export/export.h"

namespace pillarfield::viewer {

/// Writes a picture of every frame of the source while the window stays responsive: seeks a frame,
/// then takes its picture.
class FrameWriter {
 public:
  enum class Kind : std::uint8_t { pictures, video };

  /// Seeks the first frame. Throws Error where a video cannot start.
  FrameWriter(AppState& state, Kind kind, std::filesystem::path path, std::uint32_t width,
              std::uint32_t height);
  ~FrameWriter();
  FrameWriter(const FrameWriter&) = delete;
  FrameWriter& operator=(const FrameWriter&) = delete;

  /// True if the field on display is the frame to write.
  [[nodiscard]] bool wants_picture();

  /// Writes the picture of that frame; returns true after the last one.
  bool add(const Pixels& pixels);

 private:
  AppState* state_;
  std::filesystem::path path_;
  std::unique_ptr<VideoWriter> video_;
  std::uint64_t next_ = 0;
  std::uint64_t frames_;
};

/// A new name in the current folder: "demo_normal.png" for the source demo.h5, else
/// "demo_normal_2.png" and so on. `detail` may be empty.
[[nodiscard]] std::filesystem::path free_path(const SourceInfo& source, const std::string& detail,
                                              const char* ending);

/// A new name for a sequence of PNG files, by its first frame.
[[nodiscard]] std::filesystem::path free_sequence_path(const SourceInfo& source,
                                                       const std::string& detail);

}  // namespace pillarfield::viewer
