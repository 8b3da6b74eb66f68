#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "viewer/app/panels/panel_style.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/panels/plot.h"
#include "viewer/app/panels/widgets.h"
#include "viewer/style/quantity.h"

namespace pillarfield::viewer {
namespace {

std::string rect_words(const PillarRect& rect) {
  return fmt::format("rows {}–{}, columns {}–{}", rect.row_begin, rect.row_end - 1, rect.col_begin,
                     rect.col_end - 1);
}

std::string size_words(const PillarRect& rect, const Pitch& pitch_mm, const Units& units) {
  return fmt::format(
      "{} × {}", units.number(Dimension::length, (rect.col_end - rect.col_begin) * pitch_mm.col_mm),
      units.text(Dimension::length, (rect.row_end - rect.row_begin) * pitch_mm.row_mm));
}

/// Total force and pressure of the selection.
std::vector<ShownValue> force_lines(const SelectionSums& sums, const Skin& skin,
                                    const Units& units) {
  const auto kpa = static_cast<double>(kpa_per_newton(skin));
  std::vector<ShownValue> lines{units.readout("normal", Dimension::force, sums.normal),
                                units.readout("mean", Dimension::pressure, kpa * sums.mean_normal),
                                units.readout("peak", Dimension::pressure, kpa * sums.peak_normal)};
  if (!skin.has_pillars()) return lines;
  lines.push_back(
      units.readout("|shear|", Dimension::force, std::hypot(sums.shear_x, sums.shear_y)));
  lines.push_back(units.readout("shear x", Dimension::force, sums.shear_x));
  lines.push_back(units.readout("shear y", Dimension::force, sums.shear_y));
  const double rounding = 1e-6 * sums.normal * std::sqrt(sums.area_mm2);
  lines.push_back(units.readout("moment z", Dimension::torque,
                                std::abs(sums.moment_z) < rounding ? 0 : sums.moment_z));
  return lines;
}

/// Centre of pressure to 0.01 mm, area, mean and peak.
std::vector<ShownValue> spread_lines(const SelectionSums& sums, const Units& units) {
  const auto place = [&](const char* label, double mm) {
    return units.readout(label, Dimension::length, std::round(100 * mm) / 100);
  };
  std::vector<ShownValue> lines{place("centre x", sums.centre_x_mm),
                                place("centre y", sums.centre_y_mm),
                                units.readout("area", Dimension::area, sums.area_mm2),
                                units.readout("mean", Dimension::force, sums.mean_normal),
                                units.readout("peak", Dimension::force, sums.peak_normal)};
  if (sums.in_contact > 0) {
    lines.back().unit += fmt::format("  at {}, {}", sums.peak.row, sums.peak.col);
  }
  return lines;
}

/// Two tables, side by side if they fit.
void draw_tables(const PanelStyle& style, const SelectionSums& sums, const Skin& skin,
                 const Units& units) {
  const double available = static_cast<double>(ImGui::GetContentRegionAvail().x);
  value_table(style, force_lines(sums, skin, units));
  const double second = value_table_width(style) - 60 * style.unit;
  if (second + value_table_width(style) <= available) {
    ImGui::SameLine(0, 0);
    ImGui::SetCursorPosX(ImGui::GetCursorStartPos().x + static_cast<float>(second));
  } else {
    leave_gap(style, 2);
  }
  value_table(style, spread_lines(sums, units));
}

constexpr std::array<Region, 5> kShown{Region::one, Region::two, Region::three, Region::four,
                                       Region::opposite};

std::array<std::uint64_t, 5> shown_counts(const SelectionSums& sums) {
  std::array<std::uint64_t, 5> counts{};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    counts[i] = sums.by_region[static_cast<std::size_t>(kShown[i])];
  }
  return counts;
}

void draw_shares(const PanelStyle& style, const SelectionSums& sums, Theme theme) {
  const Viewport bar = reserve(0, std::round(10 * style.unit));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  draw_block(list, bar, mixed(style.ground, style.text, 0.12));
  const auto widths = shares_of(shown_counts(sums), static_cast<int>(bar.width));
  double x = bar.x;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    if (widths[i] > 0) {
      draw_block(list, {x, bar.y, static_cast<double>(widths[i]), bar.height},
                 packed(region_colour(kShown[i], theme)));
    }
    x += widths[i];
  }
}

std::string share_words(std::uint64_t count, std::uint64_t all) {
  const double percent = 100 * static_cast<double>(count) / static_cast<double>(all);
  return fmt::format("{:.{}f} %", percent, percent < 9.95 ? 1 : 0);
}

/// Legend of the shares, wrapped into lines.
void draw_legend(const PanelStyle& style, const SelectionSums& sums, Theme theme) {
  const auto counts = shown_counts(sums);
  const double cell = 76 * style.unit;
  const double available = static_cast<double>(ImGui::GetContentRegionAvail().x);
  double used = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (kShown[i] == Region::opposite && counts[i] == 0) continue;
    if (used > 0 && used + cell <= available) {
      ImGui::SameLine(ImGui::GetCursorStartPos().x + static_cast<float>(used));
    } else {
      used = 0;
    }
    swatch(style, packed(region_colour(kShown[i], theme)));
    const std::string words =
        fmt::format("{}  {}", name_of(kShown[i]), share_words(counts[i], sums.in_contact));
    ImGui::TextUnformatted(words.c_str());
    used += cell;
  }
}

std::string fault_words(const SelectionSums& sums) {
  return fmt::format("{} ambiguous, {} saturated, {} inconsistent", sums.ambiguous, sums.saturated,
                     sums.inconsistent);
}

}  // namespace

void selection_panel(AppState& state) {
  const PanelStyle style = panel_style(state.look.settings.scale);
  if (!state.marks.selection || !state.source.field) {
    faint_text(style, "Nothing is selected.");
    return;
  }
  const PillarRect& rect = state.marks.selection->rect;
  const Skin& skin = state.source.player->info().skin;
  const SelectionSums& sums = selection_sums(state);
  heading(style, rect_words(rect),
          size_words(rect, skin.element_pitch_mm(), state.look.settings.units));
  leave_gap(style, 2);
  draw_tables(style, sums, skin, state.look.settings.units);
  leave_gap(style, 4);
  const std::string touched = fmt::format("{} of {} in contact", sums.in_contact, sums.pillars);
  if (!skin.has_pillars()) {
    heading(style, touched);
    return faint_text(
        style, fmt::format("{} saturated, {} without a reading", sums.saturated, sums.inconsistent)
                   .c_str());
  }
  heading(style, "Regions of usable sensels", touched);
  if (sums.in_contact == 0) return;
  draw_shares(style, sums, state.look.settings.theme);
  draw_legend(style, sums, state.look.settings.theme);
  faint_text(style, fault_words(sums).c_str());
}

const SelectionSums& selection_sums(AppState& state) {
  Selection& selection = *state.marks.selection;
  const std::uint64_t frame = state.source.field->index;
  if (!selection.cached || selection.cached->frame != frame ||
      selection.cached->rect != selection.rect) {
    const Pitch pitch_mm = state.source.player->info().skin.element_pitch_mm();
    selection.cached = {frame, selection.rect,
                        sums_over(*state.source.field, selection.rect, pitch_mm)};
  }
  return selection.cached->sums;
}

}  // namespace pillarfield::viewer
