#include "viewer/app/panels/value_table.h"

#include <algorithm>

namespace pillarfield::viewer {
namespace {

constexpr double kLabelWidth = 74;
constexpr double kValueWidth = 56;
constexpr double kGap = 8;
constexpr double kRangeWidth = 100;

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
  const bool bare = shown.range.empty();
  const bool close = shown.unit == "°";
  faint(style, bare ? shown.unit : shown.range + (close ? "" : " ") + shown.unit);
}

}  // namespace

void value_table(const PanelStyle& style, std::span<const ShownValue> values) {
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, to_imgui({0, 2 * style.unit}));
  ImGui::BeginGroup();
  for (const ShownValue& value : values) line(style, value);
  ImGui::EndGroup();
  ImGui::PopStyleVar();
}

void readouts(const PanelStyle& style, std::span<const ShownValue> values, double width) {
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, to_imgui({0, style.unit}));
  ImGui::BeginGroup();
  const double right = static_cast<double>(ImGui::GetCursorPosX()) + width;
  for (const ShownValue& shown : values) {
    const bool close = shown.unit == "°";
    const std::string value = shown.value + (close ? "" : " ") + shown.unit;
    faint(style, shown.label);
    ImGui::SameLine();
    ImGui::SetCursorPosX(static_cast<float>(right - width_of(value)));
    ImGui::TextUnformatted(value.c_str());
    ImGui::SetCursorPosX(static_cast<float>(right - width_of(shown.range)));
    faint(style, shown.range);
    leave_gap(style, 12);
  }
  ImGui::EndGroup();
  ImGui::PopStyleVar();
}

double value_table_width(const PanelStyle& style) {
  return (kLabelWidth + kValueWidth + kGap + kRangeWidth) * style.unit;
}

}  // namespace pillarfield::viewer
