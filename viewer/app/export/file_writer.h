#pragma once

#include <filesystem>
#include <functional>
#include <memory>

#include "viewer/app/export/export.h"
#include "viewer/app/input/shortcuts.h"

namespace pillarfield::viewer {

/// Writes what the user asks for under new names in the current folder: the picture on display, the
/// visible forces, a video of all frames, a recording of a sensor.
class FileWriter {
 public:
  /// Reads the pixels of the picture on display.
  using Read = std::function<Pixels()>;

  explicit FileWriter(AppState& state);
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  /// Writes what is asked for; an Error becomes a notice.
  void serve(const PendingActions& asked, const FieldPlace& place, const Read& read);

  /// Goes on with all frames: the window stays responsive, since each frame is sought and written
  /// once it is on display. True while there are more.
  bool go_on(const Read& read);

  /// Stops writing frames.
  void stop();

 private:
  struct Frames;

  [[nodiscard]] std::filesystem::path new_file(const std::string& detail, const char* ending,
                                               OutputKind kind) const;
  void begin_video(const Read& read);
  void toggle_recording();
  [[nodiscard]] bool wants_picture() const;
  void add(const Pixels& pixels);

  AppState* state_;
  std::unique_ptr<Frames> frames_;  ///< null: no frames are written
};

}  // namespace pillarfield::viewer
