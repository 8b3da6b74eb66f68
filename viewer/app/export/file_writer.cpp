#include "viewer/app/export/file_writer.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "pillarfield/error.h"

namespace pillarfield::viewer {
namespace {

/// The first of NAME_DETAIL, NAME_DETAIL_2, ... that does not exist.
std::filesystem::path first_free(const SourceInfo& source, const std::string& detail,
                                 const char* ending) {
  std::string stem = std::filesystem::path(source.name).stem().string();
  if (source.frames == 0) {  // Live, no path: "udp:127.0.0.1:9870".
    stem = source.name;
    for (char& letter : stem) {
      if (std::string_view(":./ ").find(letter) != std::string_view::npos) letter = '_';
    }
  }
  if (!detail.empty()) stem += "_" + detail;
  std::filesystem::path path = stem + ending;
  for (int number = 2; std::filesystem::exists(std::filesystem::symlink_status(path)); ++number) {
    path = fmt::format("{}_{}{}", stem, number, ending);
  }
  return path;
}

}  // namespace

/// The frames that are being written.
struct FileWriter::Frames {
  std::filesystem::path path;
  std::uint64_t count = 0;
  std::uint64_t next = 0;
  std::unique_ptr<VideoWriter> video;
};

FileWriter::FileWriter(AppState& state) : state_(&state) {}
FileWriter::~FileWriter() = default;

void FileWriter::serve(const PendingActions& asked, const FieldPlace& place, const Read& read) {
  const ShownLook& look = state_->look;
  const ShownField& field = *state_->source.field;
  Notice& notice = state_->window.notice;
  try {
    if (asked.picture) {
      const auto path = new_file(info_of(look.settings.quantity).name, ".png", OutputKind::png);
      write_png(path, read(), Replace::nothing);
      notice = "wrote " + path.string();
    }
    if (asked.table) {
      const auto path =
          new_file(fmt::format("frame_{}", field.index + 1), ".csv", OutputKind::forces);
      write_csv(path, field, visible_pillars(place, look.settings), Replace::nothing);
      notice = "wrote " + path.string();
    }
    if (asked.video) begin_video(read);
    if (asked.record) toggle_recording();
  } catch (const Error& error) {
    notice.fail(error.what());
  }
  if (!asked.stop || frames_ == nullptr) return;
  stop();
  notice = "stopped writing";
}

void FileWriter::stop() {
  frames_.reset();
  state_->window.writing = false;
}

/// A new name, "demo_normal.png" for the source demo.h5, else "demo_normal_2.png" and so on.
std::filesystem::path FileWriter::new_file(const std::string& detail, const char* ending,
                                           OutputKind kind) const {
  auto path = first_free(state_->source.player->info(), detail, ending);
  check_outputs({state_->source.name}, {{path, kind}}, Replace::nothing);
  return path;
}

void FileWriter::begin_video(const Read& read) {
  if (frames_ != nullptr) return;
  Player& player = *state_->source.player;
  const SourceInfo& source = player.info();
  if (player.live() != nullptr) {
    throw Error(source.name, "a sensor has no last frame to write", "record it");
  }
  const auto path =
      new_file(info_of(state_->look.settings.quantity).name, ".mp4", OutputKind::video);
  const Pixels size = read();
  auto video = std::make_unique<VideoWriter>(
      path, size.width, size.height, source.rate_hz * player.state().speed, Replace::nothing);
  frames_ = std::make_unique<Frames>(Frames{path, player.state().frames, 0, std::move(video)});
  state_->window.writing = true;
  player.pause();
  player.seek(0);
}

void FileWriter::toggle_recording() {
  const SourceInfo& source = state_->source.player->info();
  LiveControl* const live = state_->source.player->live();
  if (live == nullptr) {
    throw Error(source.name, "only a sensor can be recorded", "open a live source");
  }
  if (!live->status().recording.empty()) return live->stop_recording();
  const auto path = first_free(source, "recording", ".h5");
  live->record(path);
  state_->window.notice = "recording " + path.string();
}

bool FileWriter::go_on(const Read& read) {
  if (frames_ == nullptr || !wants_picture()) return false;
  try {
    add(read());
  } catch (const Error& error) {
    state_->window.notice.fail(error.what());
    stop();
  }
  return true;
}

/// True if the fields on display are those to write.
bool FileWriter::wants_picture() const {
  const ShownSource& source = state_->source;
  const std::uint64_t next = frames_->next;
  if (const PlayerState player = source.player->state(); player.playing || player.frame != next) {
    source.player->pause();  // The user played on or went elsewhere.
    source.player->seek(next);
  }
  return source.field && source.field->index == next;
}

void FileWriter::add(const Pixels& pixels) {
  Frames& frames = *frames_;
  Notice& notice = state_->window.notice;
  frames.video->add(pixels);
  if (++frames.next < frames.count) {
    notice = fmt::format("writing {} of {} (Esc stops)", frames.next, frames.count);
    return state_->source.player->seek(frames.next);
  }
  frames.video->finish();
  notice = fmt::format("wrote {} frames: {}", frames.count, frames.path.string());
  stop();
}

}  // namespace pillarfield::viewer
