#pragma once

#include <filesystem>
#include <memory>

#include "viewer/app/app_state.h"
#include "viewer/app/export/export.h"

namespace pillarfield::viewer {

/// Writes a picture of every frame of the source, one after the other, while the window goes on:
/// it asks the player for a frame, and takes its picture when that has come.
class FrameWriter {
 public:
  enum class Kind : std::uint8_t { pictures, video };

  /// Begins with the first frame. Throws Error where a video cannot be begun.
  FrameWriter(AppState& state, Kind kind, std::filesystem::path path, std::uint32_t width,
              std::uint32_t height);
  ~FrameWriter();
  FrameWriter(const FrameWriter&) = delete;
  FrameWriter& operator=(const FrameWriter&) = delete;

  /// Whether the field on display is the frame that it waits for.
  [[nodiscard]] bool wants_picture() const;

  /// The picture it waited for. True when it was the last one.
  bool add(const Pixels& pixels);

 private:
  AppState* state_;
  std::filesystem::path path_;
  std::unique_ptr<VideoWriter> video_;
  std::uint64_t next_ = 0;
  std::uint64_t frames_;
};

/// "demo_normal.png" of a source demo.h5, in the current folder; where that is taken,
/// "demo_normal_2.png" and so on. `detail` may be empty.
[[nodiscard]] std::filesystem::path free_path(const SourceInfo& source, const std::string& detail,
                                              const char* ending);

/// The same of a sequence of PNG, whose first frame is not there yet.
[[nodiscard]] std::filesystem::path free_sequence_path(const SourceInfo& source,
                                                       const std::string& detail);

}  // namespace pillarfield::viewer
