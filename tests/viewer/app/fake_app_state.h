#pragma once

#include <imgui_internal.h>

#include <initializer_list>
#include <memory>
#include <string>
#include <variant>

#include "pillarfield/status.h"
#include "viewer/app/input/actions.h"
#include "viewer/app/input/gui_input.h"
#include "viewer/app/input/shortcuts.h"

namespace pillarfield::viewer {

/// Fields of 20 x 30 pressed pillars, or sensels, with forces that increase to the right.
class FakeProducer final : public FieldProducer {
 public:
  static constexpr std::uint32_t kRows = 20;
  static constexpr std::uint32_t kCols = 30;
  static constexpr std::uint64_t kFrames = 100;

  explicit FakeProducer(SkinLayout layout = SkinLayout::pillars) {
    const std::uint32_t side = layout == SkinLayout::pillars ? 2 : 1;
    info_.name = "fake.h5";
    info_.skin.layout = layout;
    info_.skin.rows = side * kRows;
    info_.skin.cols = side * kCols;
    info_.frames = kFrames;
    info_.has_readings = info_.has_uncertainty = true;
    info_.has_angles = layout == SkinLayout::pillars;
    info_.contacts.layout = layout;
  }
  [[nodiscard]] const SourceInfo& info() const override { return info_; }

  [[nodiscard]] ShownField produce(std::uint64_t index) override {
    auto memory = std::make_shared<ForceField>(info_.skin);
    for (std::size_t i = 0; i < memory->elements(); ++i) {
      memory->normal[i] = 0.1f * static_cast<float>(i % kCols);
      if (info_.skin.has_pillars()) memory->shear_x[i] = 0.03f;
      memory->status[i] = info_.skin.has_pillars() ? status::kUsable : status::kSensel1;
    }
    ShownField field;
    field.forces = memory->view();
    field.index = index;
    field.time_s = 0.01 * static_cast<double>(index);
    field.keep_alive = memory;
    return field;
  }

 private:
  SourceInfo info_;
};

/// The state of a window of 1000 x 700 pixels with a picture of 800 x 600.
struct FakeAppState {
  AppState state;
  FieldPlace place;
  PendingActions pending;

  explicit FakeAppState(SkinLayout layout = SkinLayout::pillars) {
    state.source.player = play_file(std::make_unique<FakeProducer>(layout));
    place = {{0, 0, 800, 600}, &player().info()};
    take_field(state, FakeProducer(layout).produce(0));
    reset_view(state, place);
  }
  [[nodiscard]] Player& player() const { return *state.source.player; }
  [[nodiscard]] Command command() { return {state, place, pending}; }

  /// Window pixel of the centre of a pillar.
  [[nodiscard]] Vec2 pixel(std::uint32_t row, std::uint32_t col) const {
    const Vec2 corner = corner_of(place, row, col);
    const double half = 0.5 * player().info().skin.pillar_pitch_mm();
    return pixel_of(place, state.look.settings, {corner.x + half, corner.y - half}).value();
  }
};

/// An ImGui window without a display, whose widgets are pressed by their names.
class FakeGui {
 public:
  FakeGui() : context_(ImGui::CreateContext()) {
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = ImVec2(500, 1600);
    unsigned char* pixels = nullptr;
    io.Fonts->GetTexDataAsAlpha8(&pixels, nullptr, nullptr);
  }
  ~FakeGui() { ImGui::DestroyContext(context_); }
  FakeGui(const FakeGui&) = delete;
  FakeGui& operator=(const FakeGui&) = delete;

  /// Draws a frame; returns its words.
  template <class Draw>
  std::string frame(const Draw& draw) {
    input.begin_frame(0.02);
    ImGui::NewFrame();
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(ImGui::GetIO().DisplaySize);
    ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoTitleBar);
    ImGui::LogToBuffer();
    draw();
    std::string words = context_->LogBuffer.c_str();
    ImGui::LogFinish();
    ImGui::End();
    ImGui::Render();
    return words;
  }

  /// Presses the widget at the end of a path of ImGui's names and numbers.
  using Name = std::variant<const char*, int>;
  template <class Draw>
  void press(std::initializer_list<Name> path, const Draw& draw, const char* window = "panel") {
    frame(draw);
    ImGuiID id = ImGui::FindWindowByName(window)->ID;
    for (const Name& name : path) {
      const int* const number = std::get_if<int>(&name);
      id = number != nullptr ? ImHashData(number, sizeof *number, id)
                             : ImHashStr(std::get<const char*>(name), 0, id);
    }
    ImGui::ActivateItem(id);
    frame(draw);
    frame(draw);
  }

  GuiInput input;

 private:
  ImGuiContext* context_;
};

}  // namespace pillarfield::viewer
