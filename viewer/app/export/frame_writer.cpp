#include "viewer/app/export/frame_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace pillarfield::viewer {
namespace {

/// The first of NAME_DETAIL, NAME_DETAIL_2, ... for which the file `looked_for` does not exist.
template <class LookedFor>
std::filesystem::path first_free(const SourceInfo& source, const std::string& detail,
                                 const char* ending, const LookedFor& looked_for) {
  std::string stem = std::filesystem::path(source.name).stem().string();
  if (source.frames == 0) {  // Live, no path: "udp:127.0.0.1:9870".
    stem = source.name;
    for (char& letter : stem) {
      if (std::string_view(":./ ").find(letter) != std::string_view::npos) letter = '_';
    }
  }
  if (!detail.empty()) stem += "_" + detail;
  std::filesystem::path path = stem + ending;
  for (int number = 2; std::filesystem::exists(std::filesystem::symlink_status(looked_for(path)));
       ++number) {
    path = fmt::format("{}_{}{}", stem, number, ending);
  }
  return path;
}

}  // namespace

FrameWriter::FrameWriter(AppState& state, Kind kind, std::filesystem::path path,
                         std::uint32_t width, std::uint32_t height)
    : state_(&state), path_(std::move(path)), frames_(state.player->state().frames) {
  if (kind == Kind::video) {
    const double rate = state.player->info().rate_hz * state.player->state().speed;
    video_ = std::make_unique<VideoWriter>(path_, width, height, rate, Replace::nothing);
  }
  state.writing = true;
  state.player->pause();
  state.player->seek(0);
}

FrameWriter::~FrameWriter() { state_->writing = false; }

bool FrameWriter::wants_picture() {
  if (const PlayerState player = state_->player->state(); player.playing || player.frame != next_) {
    state_->player->pause();  // The user played on or went elsewhere.
    state_->player->seek(next_);
  }
  if (!state_->field || state_->field->index != next_) return false;
  if (state_->beside == nullptr || state_->beside->live() != nullptr) return true;
  const std::uint64_t last = state_->beside->info().frames - 1;
  return state_->beside_field && state_->beside_field->index == std::min(next_, last);
}

bool FrameWriter::add(const Pixels& pixels) {
  if (video_ != nullptr) {
    video_->add(pixels);
  } else {
    write_png(numbered(path_, next_ + 1, frames_), pixels, Replace::nothing);
  }
  ++next_;
  if (next_ < frames_) {
    state_->notice = fmt::format("writing {} of {} (Esc stops)", next_, frames_);
    state_->player->seek(next_);
    return false;
  }
  if (video_ != nullptr) video_->finish();
  state_->notice =
      fmt::format("wrote {} frames: {}", frames_,
                  video_ != nullptr ? path_.string()
                                    : fmt::format("{} to {}", numbered(path_, 1, frames_).string(),
                                                  numbered(path_, frames_, frames_).string()));
  return true;
}

std::filesystem::path free_path(const SourceInfo& source, const std::string& detail,
                                const char* ending) {
  return first_free(source, detail, ending, [](const auto& path) { return path; });
}

std::filesystem::path free_sequence_path(const SourceInfo& source, const std::string& detail) {
  return first_free(source, detail, ".png",
                    [&](const auto& path) { return numbered(path, 1, source.frames); });
}

}  // namespace pillarfield::viewer
