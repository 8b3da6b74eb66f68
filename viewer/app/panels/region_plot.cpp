#include "viewer/app/panels/region_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "viewer/app/panels/format_value.h"
#include "viewer/app/panels/panel_style.h"
#include "viewer/source/selection.h"
#include "viewer/style/region_diagram.h"

namespace pillarfield::viewer {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;
constexpr int kBorderPoints = 97;

double in_degrees(float radians) { return static_cast<double>(radians) * kDegreesPerRadian; }

int sensel_bit(int sensel) { return 1 << (sensel - 1); }

/// Sensel n of the usable pair n, n % 4 + 1; 0 outside region 3.
int first_of_pair(std::uint8_t status) {
  if (region_of(status) != Region::three) return 0;
  for (int sensel = 1; sensel <= 4; ++sensel) {
    const int pair = sensel_bit(sensel) | sensel_bit(sensel % 4 + 1);
    if ((status & status::kUsable) == pair) return sensel;
  }
  return 0;
}

/// Equation (2) with k = 1 count per newton.
double model_reading(const PillarValues& values, int sensel) {
  const double place = std::numbers::pi / 4 * (2 * sensel - 1);
  return std::max(0.0, static_cast<double>(values.normal) +
                           static_cast<double>(values.shear_x) * std::cos(place) +
                           static_cast<double>(values.shear_y) * std::sin(place));
}

/// Theta of a border at phi, degrees; 90 without a border.
double border_at(const std::vector<std::vector<Vec2>>& pieces, double phi) {
  const double x = phi / kDegreesPerRadian;
  for (const auto& piece : pieces) {
    if (piece.empty() || x < piece.front().x || x > piece.back().x) continue;
    const auto after = std::ranges::lower_bound(piece, x, {}, &Vec2::x);
    if (after == piece.begin()) return after->y * kDegreesPerRadian;
    const auto before = after - 1;
    const double share = (x - before->x) / (after->x - before->x);
    return (before->y + share * (after->y - before->y)) * kDegreesPerRadian;
  }
  return 90;
}

using Borders = std::array<std::vector<std::vector<Vec2>>, 4>;

const Borders& borders() {
  static const Borders known = region_borders(kBorderPoints);
  return known;
}

/// Draws the plot of one pillar.
class Drawing {
 public:
  Drawing(ImDrawList& list, const PlotArea& area, const PanelStyle& style, Theme theme,
          const PillarValues& values)
      : list_(list),
        area_(area),
        style_(style),
        theme_(theme),
        usable_(values.status & status::kUsable),
        point_{in_degrees(values.phi), std::min(in_degrees(values.theta), 90.0)} {}

  void tint() const;
  void draw_borders() const;
  void draw_numbers() const;
  void draw_corners() const;
  void draw_box(const DirectionBox& box, ImU32 colour) const;
  void draw_line(const std::vector<Vec2>& line, ImU32 colour, double width) const;
  void draw_trail(std::span<const CurvePoint> points, ImU32 colour) const;
  void draw_point(ImU32 colour) const;

 private:
  [[nodiscard]] ImU32 tint_of(int usable) const {
    const Region region = region_of(static_cast<std::uint8_t>(usable));
    const double share = usable == usable_ ? 0.5 : 0.13;
    return mixed(style_.ground, packed(region_colour(region, theme_)), share);
  }
  void strip(double left, double right, Span from, Span to, int usable) const;
  void number(const char* words, Vec2 place, int inactive, Align align = Align::middle) const;

  ImDrawList& list_;
  const PlotArea& area_;
  const PanelStyle& style_;
  Theme theme_;
  int usable_;  ///< sensel bits of a status byte
  Vec2 point_;  ///< phi and theta, degrees
};

/// A strip between theta intervals (degrees) at its left and right end.
void Drawing::strip(double left, double right, Span from, Span to, int usable) const {
  list_.AddQuadFilled(to_imgui(area_.at({left, from.from})), to_imgui(area_.at({right, to.from})),
                      to_imgui(area_.at({right, to.to})), to_imgui(area_.at({left, from.to})),
                      tint_of(usable));
}

void Drawing::tint() const {
  // Antialiased edges of neighbouring strips would show the background.
  const ImDrawListFlags flags = list_.Flags;
  list_.Flags &= ~ImDrawListFlags_AntiAliasedFill;
  constexpr double kStep = 3;
  constexpr int kStrips = 120;
  for (int i = 0; i < kStrips; ++i) {
    const double phi = -180 + kStep * i;
    const RegionLimits left = region_limits(phi);
    const RegionLimits right = region_limits(phi + kStep);
    // Borders cross at multiples of the step; sample between them.
    const RegionLimits middle = region_limits(phi + kStep / 2);
    const int three = status::kUsable & ~sensel_bit(middle.first);
    const int two = three & ~sensel_bit(middle.second);
    strip(phi, phi + kStep, {0, left.four}, {0, right.four}, status::kUsable);
    strip(phi, phi + kStep, {left.four, left.three}, {right.four, right.three}, three);
    strip(phi, phi + kStep, {left.three, 90}, {right.three, 90}, two);
  }
  list_.Flags = flags;
}

void Drawing::draw_borders() const {
  for (const auto& pieces : borders()) {
    for (const auto& piece : pieces) {
      std::vector<Vec2> line;
      line.reserve(piece.size());
      for (const Vec2& radians : piece) {
        line.push_back({radians.x * kDegreesPerRadian, radians.y * kDegreesPerRadian});
      }
      draw_line(line, mixed(style_.ground, style_.text, 0.5), 1.2 * style_.unit);
    }
  }
}

void Drawing::number(const char* words, Vec2 place, int inactive, Align align) const {
  const Vec2 pixel = area_.at(place);
  const bool here = (status::kUsable & ~inactive) == usable_;
  const Vec2 taken = area_.at(point_);
  if (here && std::hypot(pixel.x - taken.x, pixel.y - taken.y) < 1.6 * style_.line) return;
  draw_text(list_, {pixel.x, pixel.y - 0.5 * style_.line},
            here ? style_.text : mixed(style_.ground, style_.text, 0.45), words, align);
}

/// Section numbers of the paper; the digits after the point are the unusable sensels.
void Drawing::draw_numbers() const {
  number("1", {0, 21}, 0);
  number("2.3", {-135, 66}, status::kSensel3);
  number("2.4", {-45, 66}, status::kSensel4);
  number("2.1", {45, 66}, status::kSensel1);
  number("2.2", {135, 66}, status::kSensel2);
  // Positions between the borders.
  number("3.34", {-90, 80}, status::kSensel3 | status::kSensel4);
  number("3.14", {0, 80}, status::kSensel1 | status::kSensel4);
  number("3.12", {90, 80}, status::kSensel1 | status::kSensel2);
  // This section wraps around; each half may be too narrow for its number.
  const double half_width = area_.at({70.0 / 2, 0}).x - area_.at({0, 0}).x;
  if (width_of("3.23") + 3 * style_.unit > half_width) return;
  number("3.23", {-179, 80}, status::kSensel2 | status::kSensel3, Align::left);
  number("3.23", {179, 80}, status::kSensel2 | status::kSensel3, Align::right);
}

/// Draws region 4: four points at the upper edge.
void Drawing::draw_corners() const {
  // The force comes from the side opposite to the pressed sensel.
  const std::array<std::pair<double, int>, 4> corners{{{-135, status::kSensel1},
                                                       {-45, status::kSensel2},
                                                       {45, status::kSensel3},
                                                       {135, status::kSensel4}}};
  for (const auto& [phi, usable] : corners) {
    const bool here = usable_ == usable;
    list_.AddCircleFilled(to_imgui(area_.at({phi, 90})),
                          static_cast<float>((here ? 4.5 : 3) * style_.unit),
                          here ? packed(region_colour(Region::four, theme_)) : style_.faint, 16);
  }
}

void Drawing::draw_line(const std::vector<Vec2>& line, ImU32 colour, double width) const {
  std::vector<ImVec2> points;
  points.reserve(line.size());
  for (const Vec2& direction : line) points.push_back(to_imgui(area_.at(direction)));
  list_.AddPolyline(points.data(), static_cast<int>(points.size()), colour, ImDrawFlags_None,
                    static_cast<float>(width));
}

void Drawing::draw_box(const DirectionBox& box, ImU32 colour) const {
  // A box smaller than the point would be hidden.
  const ImVec2 least = to_imgui({1.5 * style_.unit, 1.5 * style_.unit});
  for (const double turn : {-360.0, 0.0, 360.0}) {
    ImVec2 low = to_imgui(area_.at({box.phi.from + turn, box.theta.to}));
    ImVec2 high = to_imgui(area_.at({box.phi.to + turn, box.theta.from}));
    if (high.x - low.x < least.x) high.x = low.x + least.x;
    if (high.y - low.y < least.y) high.y = low.y + least.y;
    list_.AddRectFilled(low, high, with_alpha(colour, 0.22));
    list_.AddRect(low, high, with_alpha(colour, 0.9), 0, ImDrawFlags_None,
                  static_cast<float>(style_.unit));
  }
}

void Drawing::draw_trail(std::span<const CurvePoint> points, ImU32 colour) const {
  const auto pieces = trail_of(points);
  std::size_t all = 0;
  for (const auto& piece : pieces) all += piece.size();
  std::size_t seen = 0;
  for (const auto& piece : pieces) {
    for (std::size_t i = 1; i < piece.size(); ++i) {
      const double age = static_cast<double>(seen + i) / static_cast<double>(all);
      list_.AddLine(to_imgui(area_.at(piece[i - 1])), to_imgui(area_.at(piece[i])),
                    with_alpha(colour, 0.75 * age), static_cast<float>(1.6 * style_.unit));
    }
    seen += piece.size();
  }
}

void Drawing::draw_point(ImU32 colour) const {
  const ImVec2 place = to_imgui(area_.at(point_));
  const auto radius = static_cast<float>(4.5 * style_.unit);
  list_.AddCircleFilled(place, radius + static_cast<float>(2 * style_.unit), style_.ground, 24);
  list_.AddCircleFilled(place, radius, colour, 24);
}

const PlotTicks& angle_ticks() {
  static const PlotTicks ticks{{{-180, "−180"}, {-90, "−90"}, {0, "0"}, {90, "90"}, {180, "180"}},
                               {{0, "0"}, {30, "30"}, {60, "60"}, {90, "90"}}};
  return ticks;
}

}  // namespace

std::optional<DirectionBox> direction_box(const PillarValues& values) {
  if (!values.uncertainty || region_of(values.status) == Region::none) return {};
  const auto plane = [&values](Uncertainty which) {
    return in_degrees((*values.uncertainty)[static_cast<std::size_t>(which)]);
  };
  DirectionBox box;
  if ((values.status & status::kAmbiguous) != 0) {
    box.phi = {plane(Uncertainty::phi_low), plane(Uncertainty::phi_high)};
    box.theta = {plane(Uncertainty::theta_low), plane(Uncertainty::theta_high)};
    if (box.phi.to < box.phi.from) box.phi.to += 360;
  } else {
    const DirectionDeviation deviation = direction_deviation(values);
    const double phi = in_degrees(values.phi);
    const double theta = in_degrees(values.theta);
    // Without shear phi is undetermined.
    const double phi_half = std::min(deviation.phi * kDegreesPerRadian, 180.0);
    const double theta_half = deviation.theta * kDegreesPerRadian;
    box.phi = std::isfinite(phi_half) ? Span{phi - phi_half, phi + phi_half} : Span{-180, 180};
    box.theta = {std::max(theta - theta_half, 0.0), theta + theta_half};
  }
  const bool known = std::isfinite(box.phi.from) && std::isfinite(box.phi.to) &&
                     std::isfinite(box.theta.from) && std::isfinite(box.theta.to);
  return known ? std::optional(box) : std::nullopt;
}

std::vector<Vec2> contour_of(const PillarValues& values) {
  const int sensel = first_of_pair(values.status);
  if (sensel == 0) return {};
  std::vector<Vec2> contour = ambiguity_contour(sensel, model_reading(values, sensel),
                                                model_reading(values, sensel % 4 + 1), 48);
  for (Vec2& direction : contour)
    direction = {direction.x * kDegreesPerRadian, direction.y * kDegreesPerRadian};
  return contour;
}

std::vector<std::vector<Vec2>> trail_of(std::span<const CurvePoint> points) {
  std::vector<std::vector<Vec2>> pieces;
  for (const CurvePoint& point : points) {
    const Direction direction = direction_of(point.shear_x, point.shear_y, point.normal);
    if (!(direction.magnitude > 0)) continue;
    const Vec2 place{in_degrees(direction.phi), in_degrees(direction.theta)};
    if (pieces.empty() || std::abs(place.x - pieces.back().back().x) > 180) pieces.emplace_back();
    pieces.back().push_back(place);
  }
  return pieces;
}

std::string section_name(std::uint8_t status) {
  const Region region = region_of(status);
  if (region == Region::none || region == Region::opposite) return {};
  std::string name = name_of(region);
  if (region != Region::one) name += ".";
  for (int sensel = 1; sensel <= 4; ++sensel) {
    if ((status & sensel_bit(sensel)) == 0) name += std::to_string(sensel);
  }
  return name;
}

RegionLimits region_limits(double phi) {
  using Limit = std::pair<double, int>;
  std::array<Limit, 4> limits;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    limits[i] = {border_at(borders()[i], phi), static_cast<int>(i) + 1};
  }
  std::ranges::sort(limits);
  return {limits[0].first, limits[1].first, limits[0].second, limits[1].second};
}

void draw_region_plot(ImDrawList& list, const Viewport& outer, const PillarValues& values,
                      std::span<const CurvePoint> before, const PanelStyle& style, ImU32 colour,
                      Theme theme) {
  const PlotArea area{inside_axes(outer, width_of("90"), style), {-180, 180}, {0, 90}};
  const Viewport& box = area.box;
  const Drawing drawing(list, area, style, theme, values);
  draw_axes(list, area, angle_ticks(), style);
  list.PushClipRect(to_imgui({box.x, box.y}), to_imgui({box.x + box.width, box.y + box.height}),
                    true);
  drawing.tint();
  drawing.draw_borders();
  drawing.draw_numbers();
  drawing.draw_trail(before, colour);
  if (const auto directions = direction_box(values)) drawing.draw_box(*directions, colour);
  for (const double turn : {-360.0, 0.0, 360.0}) {
    std::vector<Vec2> contour = contour_of(values);
    for (Vec2& direction : contour) direction.x += turn;
    drawing.draw_line(contour, style.text, 1.8 * style.unit);
  }
  list.PopClipRect();
  drawing.draw_corners();
  if (region_of(values.status) != Region::none) drawing.draw_point(colour);
}

}  // namespace pillarfield::viewer
