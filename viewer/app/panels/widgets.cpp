#include "viewer/app/panels/widgets.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "viewer/app/panels/format_value.h"
#include "viewer/style/ticks.h"

namespace pillarfield::viewer {
namespace {

/// Background of a button.
ImU32 ground(bool lit, bool hovered, bool held) {
  if (held) return ImGui::GetColorU32(ImGuiCol_ButtonActive);
  if (hovered) return ImGui::GetColorU32(ImGuiCol_ButtonHovered);
  return lit ? ImGui::GetColorU32(ImGuiCol_Header) : 0;
}

void tip(const char* help) {
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", help);
}

}  // namespace

bool section(const char* title) {
  ImGui::Spacing();
  ImGui::PushStyleColor(ImGuiCol_Header, 0);
  ImGui::PushStyleColor(ImGuiCol_HeaderHovered, 0);
  ImGui::PushStyleColor(ImGuiCol_HeaderActive, 0);
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetColorU32(ImGuiCol_TextDisabled));
  const bool open = ImGui::CollapsingHeader(title, ImGuiTreeNodeFlags_DefaultOpen);
  ImGui::PopStyleColor(4);
  const ImVec2 low = ImGui::GetItemRectMin();
  const ImVec2 high = ImGui::GetItemRectMax();
  ImGui::GetWindowDrawList()->AddRectFilled(ImVec2(low.x, high.y), ImVec2(high.x, high.y + 1),
                                            ImGui::GetColorU32(ImGuiCol_Separator));
  if (open) ImGui::Spacing();
  return open;
}

void labelled(const char* label) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", label);
  ImGui::SameLine(ImGui::GetFontSize() * 4.9f);
  ImGui::SetNextItemWidth(-1);
}

bool icon_button(const char* id, Icon icon, bool lit, const char* help) {
  const float side = std::round(ImGui::GetFontSize() * 2);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const bool pressed = ImGui::InvisibleButton(id, ImVec2(side, side));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImU32 back = ground(lit, ImGui::IsItemHovered(), ImGui::IsItemActive());
  list.AddRectFilled(corner, ImVec2(corner.x + side, corner.y + side), back,
                     ImGui::GetStyle().FrameRounding);
  const ImU32 colour = ImGui::GetColorU32(lit ? ImGuiCol_CheckMark : ImGuiCol_Text);
  icon(list, ImVec2(corner.x + side / 2, corner.y + side / 2), side * 0.42f, colour);
  tip(help);
  return pressed;
}

namespace icon {
namespace {

/// A triangle that points right (`way` 1) or left (-1).
void triangle(ImDrawList& list, const ImVec2& middle, float width, float height, float way,
              unsigned colour) {
  const float back = middle.x - way * width / 2;
  const ImVec2 tip(middle.x + way * width / 2, middle.y);
  list.AddTriangleFilled(ImVec2(back, middle.y - height / 2), tip,
                         ImVec2(back, middle.y + height / 2), colour);
}

void box(ImDrawList& list, const ImVec2& middle, float width, float height, unsigned colour) {
  list.AddRectFilled(ImVec2(middle.x - width / 2, middle.y - height / 2),
                     ImVec2(middle.x + width / 2, middle.y + height / 2), colour);
}

void step(ImDrawList& list, const ImVec2& middle, float side, float way, unsigned colour) {
  triangle(list, ImVec2(middle.x + way * side * 0.12f, middle.y), side * 0.6f, side * 0.8f, way,
           colour);
  box(list, ImVec2(middle.x - way * side * 0.38f, middle.y), side * 0.16f, side * 0.8f, colour);
}

float stroke(float side) { return std::fmax(side * 0.13f, 1.0f); }

}  // namespace

void play(ImDrawList& list, const ImVec2& middle, float side, unsigned colour) {
  triangle(list, ImVec2(middle.x + side * 0.06f, middle.y), side * 0.9f, side, 1, colour);
}

void pause(ImDrawList& list, const ImVec2& middle, float side, unsigned colour) {
  for (const float way : {-1.0f, 1.0f}) {
    box(list, ImVec2(middle.x + way * side * 0.25f, middle.y), side * 0.26f, side * 0.95f, colour);
  }
}

void step_on(ImDrawList& list, const ImVec2& middle, float side, unsigned colour) {
  step(list, middle, side, 1, colour);
}

void step_back(ImDrawList& list, const ImVec2& middle, float side, unsigned colour) {
  step(list, middle, side, -1, colour);
}

void loop(ImDrawList& list, const ImVec2& middle, float side, unsigned colour) {
  constexpr float kPi = std::numbers::pi_v<float>;
  const float radius = side * 0.42f;
  list.PathArcTo(middle, radius, -0.15f * kPi, 1.45f * kPi, 24);
  list.PathStroke(colour, 0, stroke(side));
  const ImVec2 end(middle.x + side * 0.08f, middle.y - radius);
  triangle(list, end, side * 0.4f, side * 0.46f, 1, colour);
}

void follow(ImDrawList& list, const ImVec2& middle, float side, unsigned colour) {
  triangle(list, ImVec2(middle.x - side * 0.28f, middle.y), side * 0.5f, side * 0.8f, 1, colour);
  triangle(list, ImVec2(middle.x + side * 0.16f, middle.y), side * 0.5f, side * 0.8f, 1, colour);
  box(list, ImVec2(middle.x + side * 0.48f, middle.y), side * 0.14f, side * 0.8f, colour);
}

void less(ImDrawList& list, const ImVec2& middle, float side, unsigned colour) {
  box(list, middle, side * 0.75f, stroke(side), colour);
}

void more(ImDrawList& list, const ImVec2& middle, float side, unsigned colour) {
  box(list, middle, side * 0.75f, stroke(side), colour);
  box(list, middle, stroke(side), side * 0.75f, colour);
}

void record(ImDrawList& list, const ImVec2& middle, float side, unsigned /*colour*/) {
  list.AddCircleFilled(middle, side * 0.42f, IM_COL32(214, 60, 48, 255));
}

/// A zero.
void tare(ImDrawList& list, const ImVec2& middle, float side, unsigned colour) {
  const ImVec2 half(side * 0.28f, side * 0.45f);
  list.AddRect(ImVec2(middle.x - half.x, middle.y - half.y),
               ImVec2(middle.x + half.x, middle.y + half.y), colour, half.x, 0, stroke(side));
}

void question(ImDrawList& list, const ImVec2& middle, float /*side*/, unsigned colour) {
  const ImVec2 size = ImGui::CalcTextSize("?");
  list.AddText(ImVec2(std::round(middle.x - size.x / 2), std::round(middle.y - size.y / 2)), colour,
               "?");
}

}  // namespace icon

namespace {

constexpr double kLabelWidth = 74;
constexpr double kValueWidth = 56;
constexpr double kGap = 8;

void faint(const PanelStyle& style, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, style.faint);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
}

void line(const PanelStyle& style, const ShownValue& shown) {
  const double left = ImGui::GetCursorPosX();
  const double value_end = left + (kLabelWidth + kValueWidth) * style.unit;
  const auto go_to = [](double x) {
    ImGui::SameLine();
    ImGui::SetCursorPosX(static_cast<float>(x));
  };
  faint(style, shown.label);
  const double label_end = left + width_of(shown.label) + 0.5 * kGap * style.unit;
  go_to(std::max(value_end - width_of(shown.value), label_end));
  ImGui::TextUnformatted(shown.value.c_str());
  go_to(value_end + kGap * style.unit);
  faint(style, shown.range.empty() ? shown.unit : with_unit(shown.range, shown.unit));
}

}  // namespace

void value_table(const PanelStyle& style, std::span<const ShownValue> values) {
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, to_imgui({0, 2 * style.unit}));
  ImGui::BeginGroup();
  for (const ShownValue& value : values) line(style, value);
  ImGui::EndGroup();
  ImGui::PopStyleVar();
}

namespace {

constexpr Vec2 kCell{62, 80};
constexpr Vec2 kBar{24, 54};
constexpr Vec2 kBarCorner{18, 4};

/// A plane's value at a sensel; `otherwise` for an empty plane.
double value_at(const std::vector<float>& plane, std::size_t at, double otherwise) {
  return at < plane.size() ? static_cast<double>(plane[at]) : otherwise;
}

/// Row and column of sensels 1..4 within a pillar.
constexpr std::array<std::array<std::size_t, 2>, 4> kPlaces{{{0, 1}, {0, 0}, {1, 0}, {1, 1}}};

void draw_bar(ImDrawList& list, const Viewport& track, const ReadingBar& bar, double full,
              ImU32 colour, const PanelStyle& style) {
  draw_block(list, track, mixed(style.ground, style.text, 0.12));
  const double share = std::clamp(bar.reading / full, 0.0, 1.0);
  if (share > 0) {
    const double height = share * track.height;
    draw_block(list, {track.x, track.y + track.height - height, track.width, height},
               bar.usable ? colour : style.faint);
  }
  // The threshold line extends on both sides; the track ends at full scale.
  const double level = track.y + track.height * (1 - std::clamp(bar.threshold / full, 0.0, 1.0));
  const double ear = 4 * style.unit;
  draw_block(list, {track.x - ear, level, track.width + 2 * ear, style.unit}, style.text);
}

void draw_cell(ImDrawList& list, Vec2 corner, std::size_t index, const ReadingBar& bar, double full,
               ImU32 colour, const PanelStyle& style) {
  const Viewport track{corner.x + kBarCorner.x * style.unit, corner.y + kBarCorner.y * style.unit,
                       kBar.x * style.unit, kBar.y * style.unit};
  draw_bar(list, track, bar, full, colour, style);
  const bool left = kPlaces[index][1] == 0;
  const double number_x = left ? track.x - 7 * style.unit : track.x + track.width + 7 * style.unit;
  draw_text(list, {number_x, track.y - 2 * style.unit}, style.faint, std::to_string(index + 1),
            left ? Align::right : Align::left);
  draw_text(list, {track.x + 0.5 * track.width, track.y + track.height + 3 * style.unit},
            bar.usable ? style.text : style.faint, format_count(bar.reading), Align::middle);
}

}  // namespace

std::array<ReadingBar, 4> reading_bars(const PillarValues& values, PillarIndex pillar,
                                       const SourceInfo& source) {
  std::array<ReadingBar, 4> bars;
  for (std::size_t index = 0; index < bars.size(); ++index) {
    const std::size_t row = std::size_t{2} * pillar.row + kPlaces[index][0];
    const std::size_t col = std::size_t{2} * pillar.col + kPlaces[index][1];
    const std::size_t at = row * source.skin.cols + col;
    const double gain = value_at(source.calibration.gain, at, 1);
    bars[index].reading = static_cast<double>(values.readings[index]);
    bars[index].threshold =
        value_at(source.calibration.tare, at, 0) + source.skin.threshold_counts / gain;
    bars[index].usable = (values.status >> index & 1) != 0;
  }
  return bars;
}

double full_bar(const std::array<ReadingBar, 4>& bars, const SourceInfo& source, SenselType type) {
  if (source.skin.full_scale_counts) return *source.skin.full_scale_counts;
  if (type == SenselType::u8) return 255;
  double most = 1;
  for (const ReadingBar& bar : bars) {
    if (std::isfinite(bar.reading)) most = std::max(most, bar.reading);
    most = std::max(most, bar.threshold);
  }
  return nice_ceiling(most);
}

void draw_reading_bars(ImDrawList& list, Vec2 corner, const std::array<ReadingBar, 4>& bars,
                       double full, ImU32 colour, const PanelStyle& style) {
  for (std::size_t index = 0; index < bars.size(); ++index) {
    const double x = static_cast<double>(kPlaces[index][1]) * kCell.x;
    const double y = static_cast<double>(kPlaces[index][0]) * kCell.y;
    draw_cell(list, {corner.x + x * style.unit, corner.y + y * style.unit}, index, bars[index],
              full, colour, style);
  }
  draw_text(list,
            {corner.x + 0.5 * kReadingBarsSize.x * style.unit, corner.y + 2 * kCell.y * style.unit},
            style.faint, "of " + format_count(full) + " counts", Align::middle);
}

}  // namespace pillarfield::viewer
