#include <fmt/format.h>

#include <utility>

#include "pillarfield/error.h"
#include "viewer/app/application.h"

// The pending actions of an Application: opening, recording and writing files.

namespace pillarfield::viewer {

/// Performs the pending actions; an Error becomes a notice.
void Application::serve() {
  serve_open();
  const PendingActions asked = std::exchange(pending_, PendingActions{});
  pending_.quit = asked.quit;
  keep_boxes();
  if (asked.start) show_start_page();
  if (!state_.field || !shows_source()) return;
  try {
    if (asked.picture) write_picture();
    if (asked.table) write_table();
    if (asked.sequence) begin_frames(FrameWriter::Kind::pictures);
    if (asked.video) begin_frames(FrameWriter::Kind::video);
    if (asked.record) toggle_recording();
    if (asked.truth) toggle_truth();
  } catch (const Error& error) {
    state_.notice.fail(error.what());
  }
  if (asked.stop && writer_ != nullptr) {
    writer_.reset();
    state_.notice = "stopped writing";
  }
  if (asked.picture || asked.table || asked.sequence || asked.video || asked.stop || asked.record ||
      asked.truth) {
    redraws_.input(Window::now_s());
  }
}

void Application::serve_open() {
  if (pending_.open.empty()) return;
  loading_.reset();  // It may wait for a sensor for ever.
  options_.beside.clear();
  options_.truth = false;
  options_.first_frame = 0;
  at_start_ = false;
  open(std::exchange(pending_.open, {}));
}

/// Remembers the named boxes once they have changed.
void Application::keep_boxes() {
  if (state_.player == nullptr) return;
  const Skin& skin = state_.player->info().skin;
  if (user_.boxes.on(skin) == state_.boxes) return;
  user_.boxes.set(skin, state_.boxes);
  user_.save();
}

void Application::toggle_recording() {
  LiveControl* const live = state_.player->live();
  if (live == nullptr) {
    throw Error(place_.source->name, "only a sensor can be recorded", "open a live source");
  }
  if (!live->status().recording.empty()) return live->stop_recording();
  const auto path = free_path(*place_.source, "recording", ".h5");
  live->record(path);
  state_.notice = "recording " + path.string();
}

void Application::toggle_truth() {
  if (loaded_.beside != nullptr) {
    loaded_.beside->on_new_field({});
    presenter_.clear();
    state_.beside_field.reset();
    loaded_.beside.reset();
    loaded_.beside_is_truth = false;
  } else {
    show_truth(loaded_);
    loaded_.beside->seek(state_.field->index);
  }
  set_beside();
  drawn_settings_.reset();
}

/// All pictures, side by side.
Pixels Application::pixels() {
  Pixels all = read_pixels(device_, presenter_.image(0));
  for (std::size_t i = 1; i < presenter_.places().size(); ++i) {
    all = side_by_side(all, read_pixels(device_, presenter_.image(i)));
  }
  return all;
}

/// A new file of the working folder.
std::filesystem::path Application::new_file(const std::string& detail, const char* ending,
                                            OutputKind kind) const {
  auto path = free_path(*place_.source, detail, ending);
  check_outputs({options_.source}, {{path, kind}}, Replace::nothing);
  return path;
}

void Application::write_picture() {
  if (!drawn_settings_) return;
  const auto path = new_file(info_of(state_.settings.quantity).name, ".png", OutputKind::png);
  write_png(path, pixels(), Replace::nothing);
  state_.notice = "wrote " + path.string();
}

void Application::write_table() {
  const auto path =
      new_file(fmt::format("frame_{}", state_.field->index + 1), ".csv", OutputKind::forces);
  write_csv(path, *state_.field, visible_pillars(place_, state_.settings), Replace::nothing);
  state_.notice = "wrote " + path.string();
}

void Application::begin_frames(FrameWriter::Kind kind) {
  if (writer_ != nullptr) return;
  const SourceInfo& source = *place_.source;
  if (state_.player->live() != nullptr) {
    throw Error(source.name, "a sensor has no last frame to write", "record it");
  }
  const std::string quantity = info_of(state_.settings.quantity).name;
  std::filesystem::path path;
  if (kind == FrameWriter::Kind::video) {
    path = new_file(quantity, ".mp4", OutputKind::video);
  } else {
    path = free_sequence_path(source, quantity);
    check_outputs({options_.source}, {{numbered(path, 1, source.frames), OutputKind::png}},
                  Replace::nothing);
  }
  const vk::Extent2D size = extent_of(screen_.field);
  writer_ = std::make_unique<FrameWriter>(state_, kind, path, size.width, size.height);
}

void Application::continue_frames() {
  try {
    if (writer_->add(pixels())) writer_.reset();
  } catch (const Error& error) {
    state_.notice.fail(error.what());
    writer_.reset();
  }
  redraws_.field();
}

}  // namespace pillarfield::viewer
