#include "viewer/app/panels/reading_bars.h"

#include <algorithm>
#include <cmath>

#include "viewer/app/panels/format_value.h"
#include "viewer/style/ticks.h"

namespace pillarfield::viewer {
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
