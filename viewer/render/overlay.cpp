#include "viewer/render/overlay.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>
#include <vector>

#include "pillarfield/calibration.h"
#include "viewer/render/contact_marks.h"
#include "viewer/render/gui_context.h"
#include "viewer/render/imgui_point.h"
#include "viewer/render/scene.h"
#include "viewer/style/ticks.h"

namespace pillarfield::viewer {
namespace {

ImU32 packed_colour(const Colour& colour, int alpha = 255) {
  return IM_COL32(colour.red, colour.green, colour.blue, alpha);
}

/// Draw list, colours and sizes of one picture's overlay.
struct Canvas {
  ImDrawList& list;
  const RenderSettings& settings;
  ImU32 text_colour;
  ImU32 faint_colour;

  [[nodiscard]] float unit() const { return static_cast<float>(settings.scale); }

  void text(double x, double y, const std::string& text, ImU32 colour) const {
    list.AddText(ImVec2(std::round(static_cast<float>(x)), std::round(static_cast<float>(y))),
                 colour, text.c_str());
  }
  void text(double x, double y, const std::string& words) const { text(x, y, words, text_colour); }
  [[nodiscard]] static ImVec2 size_of(const std::string& text) {
    return ImGui::CalcTextSize(text.c_str());
  }
  void line(double x0, double y0, double x1, double y1, ImU32 colour) const {
    // A filled rectangle covers whole pixels.
    const float width = std::max(std::round(unit()), 1.0f);
    const float left = std::round(static_cast<float>(std::min(x0, x1)));
    const float top = std::round(static_cast<float>(std::min(y0, y1)));
    const float right = std::round(static_cast<float>(std::max(x0, x1)));
    const float bottom = std::round(static_cast<float>(std::max(y0, y1)));
    list.AddRectFilled(ImVec2(left, top),
                       ImVec2(std::max(right, left + width), std::max(bottom, top + width)),
                       colour);
  }
  void rectangle(const Viewport& box, ImU32 colour) const {
    line(box.x - 1, box.y - 1, box.x + box.width, box.y - 1, colour);
    line(box.x - 1, box.y + box.height, box.x + box.width + 1, box.y + box.height, colour);
    line(box.x - 1, box.y - 1, box.x - 1, box.y + box.height, colour);
    line(box.x + box.width, box.y - 1, box.x + box.width, box.y + box.height, colour);
  }
  [[nodiscard]] Colour special(Special kind) const { return colour_of(kind, settings.theme); }
};

/// Paper, and an outline, in place of elements that the sensor does not have: an insole has its
/// shape.
void draw_absent(const Canvas& canvas, const SourceInfo& source, const Ground& ground) {
  if (count_absent(source.calibration) == 0) return;
  const Skin& skin = source.skin;
  const Viewport& plot = ground.plot();
  canvas.list.PushClipRect(to_imgui({plot.x, plot.y}),
                           to_imgui({plot.x + plot.width, plot.y + plot.height}));
  const ImDrawListFlags flags = std::exchange(canvas.list.Flags, ImDrawListFlags_None);
  const ImU32 paper = packed_colour(background_of(canvas.settings.theme));
  for (std::uint32_t row = 0; row < skin.element_rows(); ++row) {
    for (std::uint32_t col = 0; col < skin.element_cols(); ++col) {
      if (!lacks_sensels(source.calibration, skin, row, col)) continue;
      const auto seen = ground.outline({row, row + 1, col, col + 1});
      if (seen.empty() || std::ranges::any_of(seen, &SeenPoint::hidden)) continue;
      std::vector<ImVec2> points;
      std::ranges::transform(seen, std::back_inserter(points), to_imgui);
      canvas.list.AddConvexPolyFilled(points.data(), static_cast<int>(points.size()), paper);
    }
  }
  canvas.list.Flags = flags;
  canvas.list.PopClipRect();
}

/// Black or white, whichever is seen better.
ImU32 ink_on(const Colour& ground) {
  const int light = 3 * ground.red + 6 * ground.green + ground.blue;
  return light > 1400 ? IM_COL32(0, 0, 0, 255) : IM_COL32(255, 255, 255, 255);
}

/// The values of elements, where these have room for figures; below arrows and centres of pressure.
void write_values(const Canvas& canvas, const ShownField& field, const SourceInfo& source,
                  const TopView& view, const Viewport& plot) {
  const RenderSettings& settings = canvas.settings;
  const QuantityInfo& info = info_of(settings.quantity);
  const ImVec2 most = Canvas::size_of(info.scale == Scale::diverging ? "\u22120.0000" : "0.0000");
  const auto [row_mm, col_mm] = source.skin.element_pitch_mm();
  const bool marked = settings.arrows || settings.contacts;
  const double width = col_mm * view.pixels_per_mm;
  const double height = row_mm * view.pixels_per_mm;
  if (info.scale == Scale::classes || !is_available(settings.quantity, source) ||
      width < most.x + 4 * canvas.unit() || height < most.y + 2 * canvas.unit()) {
    return;
  }
  canvas.list.PushClipRect(to_imgui({plot.x, plot.y}),
                           to_imgui({plot.x + plot.width, plot.y + plot.height}));
  const auto [first_row, first_col, rows, cols] = cells_in_sight(source, settings, plot, 1);
  for (std::uint32_t i = 0; i < rows * cols; ++i) {
    const std::uint32_t row = first_row + i / cols;
    const std::uint32_t col = first_col + i % cols;
    const std::size_t element = std::size_t{row} * source.skin.element_cols() + col;
    const auto special = special_of(settings.quantity, field.forces.status[element]);
    const float value = value_of(settings.quantity, field, source.skin, row, col);
    if (std::isnan(value) || special.value_or(Special::idle) != Special::idle) continue;
    const std::string words = settings.units.number(info.dimension, static_cast<double>(value));
    const ImVec2 size = Canvas::size_of(words);
    const double left = (col - 0.5 * source.skin.element_cols()) * width -
                        view.centre_mm.x * view.pixels_per_mm + plot.x + 0.5 * plot.width;
    const double top = (row - 0.5 * source.skin.element_rows()) * height +
                       view.centre_mm.y * view.pixels_per_mm + plot.y + 0.5 * plot.height;
    const double free = height - size.y;
    const std::size_t entry = entry_of(value, settings.range, info.scale);
    canvas.text(left + 0.5 * (width - size.x),
                top + (marked ? free - 2 * canvas.unit() : 0.5 * free), words,
                ink_on(table_of(settings.map)[entry]));
  }
  canvas.list.PopClipRect();
}

/// Name and time above the plot.
void write_title(const Canvas& canvas, const ShownField& field, const SourceInfo& source,
                 const Layout& layout) {
  const double x = layout.plot.x;
  const double y = layout.plot.y - 18 * canvas.unit();
  const std::string name = canvas.settings.title.empty() ? source.name : canvas.settings.title;
  const std::uint64_t frames = std::max(field.frames, source.frames);
  const std::string of = frames > 0 ? fmt::format(" of {}", frames) : "";
  const std::string frame =
      fmt::format("frame {}{}   {}", field.index + 1, of,
                  canvas.settings.units.fixed(Dimension::time, field.time_s, 3));
  const double right = x + Canvas::size_of(name).x + 18 * canvas.unit();
  canvas.text(x, y, name);
  if (right + Canvas::size_of(frame).x < x + layout.plot.width) {
    canvas.text(right, y, frame, canvas.faint_colour);
  }
}

void write_axes(const Canvas& canvas, const TopView& view, const Layout& layout) {
  const Viewport& plot = layout.plot;
  const double half_width = 0.5 * plot.width / view.pixels_per_mm;
  const double half_height = 0.5 * plot.height / view.pixels_per_mm;
  const double mark = 5 * canvas.unit();
  const int most_x = std::max(static_cast<int>(plot.width / (70 * canvas.unit())), 2);
  const int most_y = std::max(static_cast<int>(plot.height / (50 * canvas.unit())), 2);
  const auto [unit, factor] = canvas.settings.units.of(Dimension::length);
  for (const Tick& tick : ticks(factor * (view.centre_mm.x - half_width),
                                factor * (view.centre_mm.x + half_width), most_x)) {
    const double x =
        plot.x + 0.5 * plot.width + (tick.value / factor - view.centre_mm.x) * view.pixels_per_mm;
    const double y = plot.y + plot.height;
    canvas.line(x, y, x, y + mark, canvas.faint_colour);
    const double left = x - 0.5 * Canvas::size_of(tick.label).x;
    if (left > plot.x) canvas.text(left, y + mark, tick.label);
  }
  for (const Tick& tick : ticks(factor * (view.centre_mm.y - half_height),
                                factor * (view.centre_mm.y + half_height), most_y)) {
    const double y =
        plot.y + 0.5 * plot.height - (tick.value / factor - view.centre_mm.y) * view.pixels_per_mm;
    const ImVec2 size = Canvas::size_of(tick.label);
    canvas.line(plot.x - mark, y, plot.x, y, canvas.faint_colour);
    canvas.text(plot.x - mark - 3 * canvas.unit() - size.x, y - 0.5 * size.y, tick.label);
  }
  const std::string name(unit);
  canvas.text(plot.x - mark - 3 * canvas.unit() - Canvas::size_of(name).x,
              plot.y + plot.height + mark, name, canvas.faint_colour);
}

/// The sheet's axes as seen in the picture.
void write_triad(const Canvas& canvas, const SourceInfo& source, const Layout& layout) {
  const Surface& surface = canvas.settings.surface;
  const SkinSize size = skin_size(source);
  const Pose frame = pose_at(surface, {0, 0});
  const auto seen = [&](const Vec3& way) {
    const double length = 0.1 * std::max(size.width_mm, size.height_mm);
    const Vec3 end{frame.position_mm.x + way.x * length, frame.position_mm.y + way.y * length,
                   frame.position_mm.z + way.z * length};
    return project(canvas.settings.view, surface, size, layout.plot, end);
  };
  const auto origin = project(canvas.settings.view, surface, size, layout.plot, frame.position_mm);
  if (!origin) return;
  const double x0 = layout.plot.x + 46 * canvas.unit();
  const double y0 = layout.plot.y + layout.plot.height - 46 * canvas.unit();
  const std::array<std::pair<const char*, Vec3>, 3> axes{
      {{"x", frame.tangent_x}, {"y", frame.tangent_y}, {"n", frame.normal}}};
  double longest = 1e-9;
  for (const auto& [name, way] : axes) {
    if (const auto end = seen(way)) {
      longest = std::max(longest, std::hypot(end->x - origin->x, end->y - origin->y));
    }
  }
  for (const auto& [name, way] : axes) {
    const auto end = seen(way);
    if (!end) continue;
    const double factor = 30 * canvas.unit() / longest;
    const double x = x0 + factor * (end->x - origin->x);
    const double y = y0 + factor * (end->y - origin->y);
    canvas.list.AddLine(to_imgui({x0, y0}), to_imgui({x, y}), canvas.text_colour,
                        1.5f * canvas.unit());
    canvas.text(x + 3 * canvas.unit(), y - 9 * canvas.unit(), name);
  }
}

/// A round length at the middle of the view.
void write_scale_bar(const Canvas& canvas, const SourceInfo& source, const Layout& layout) {
  const double pixels = pixels_per_mm(canvas.settings.view, layout.plot);
  const Units& units = canvas.settings.units;
  const double factor = units.of(Dimension::length).factor;
  const double length_mm = nice_ceiling(factor * (0.08 * layout.plot.width / pixels)) / factor;
  const double length = length_mm * pixels;
  const double x = layout.plot.x + 100 * canvas.unit();
  const double y = layout.plot.y + layout.plot.height - 16 * canvas.unit();
  const double end = 4 * canvas.unit();
  canvas.line(x, y, x + length, y, canvas.text_colour);
  canvas.line(x, y - end, x, y, canvas.text_colour);
  canvas.line(x + length, y - end, x + length, y, canvas.text_colour);
  canvas.text(x, y - 22 * canvas.unit(), units.plain(Dimension::length, length_mm));
  canvas.text(x + length + 10 * canvas.unit(), y - 12 * canvas.unit(),
              "grid " + units.plain(Dimension::length, floor_step_mm(skin_size(source))),
              canvas.faint_colour);
}

void write_bar(const Canvas& canvas, const Layout& layout) {
  const RenderSettings& settings = canvas.settings;
  const Viewport& bar = layout.bar;
  const auto table = table_of(settings.map);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const auto edge = [&](std::size_t entry) {
      const double share = static_cast<double>(entry) / static_cast<double>(table.size());
      return std::round(static_cast<float>(bar.y + bar.height * (1 - share)));
    };
    const auto left = static_cast<float>(bar.x);
    const auto right = static_cast<float>(bar.x + bar.width);
    if (edge(i) > edge(i + 1)) {
      canvas.list.AddRectFilled(ImVec2(left, edge(i + 1)), ImVec2(right, edge(i)),
                                packed_colour(table[i]));
    }
  }
  canvas.rectangle(bar, canvas.faint_colour);
  const double factor = settings.units.of(info_of(settings.quantity).dimension).factor;
  const double low = settings.range.low * factor;
  const double high = settings.range.high * factor;
  const int most = std::max(static_cast<int>(bar.height / (25 * canvas.unit())), 3);
  for (const Tick& tick : ticks(low, high, most)) {
    const double y = bar.y + bar.height * (1 - (tick.value - low) / (high - low));
    const double x = bar.x + bar.width;
    canvas.line(x, y, x + 4 * canvas.unit(), y, canvas.faint_colour);
    canvas.text(x + 8 * canvas.unit(), y - 0.5 * Canvas::size_of(tick.label).y, tick.label);
  }
}

/// The colour wheel of phi.
void write_wheel(const Canvas& canvas, const Layout& layout) {
  constexpr int kSectors = 128;
  constexpr double kTurn = 2 * std::numbers::pi;
  const auto table = table_of(canvas.settings.map);
  // Labels about it are 20 nominal pixels high and 30 wide.
  const double radius = std::clamp(0.5 * layout.bar.height - 20 * canvas.unit(),
                                   10.0 * canvas.unit(), 44.0 * canvas.unit());
  const double x = layout.bar.x + radius + 24 * canvas.unit();
  const double y = layout.bar.y + radius + 18 * canvas.unit();
  const auto at = [&](double angle, double r) {
    return ImVec2(static_cast<float>(x + r * std::cos(angle)),
                  static_cast<float>(y - r * std::sin(angle)));
  };
  for (int i = 0; i < kSectors; ++i) {
    const double first = kTurn * i / kSectors - std::numbers::pi;
    const double last = kTurn * (i + 1) / kSectors - std::numbers::pi;
    const auto value = static_cast<float>(0.5 * (first + last));
    const Colour& colour = table[entry_of(value, canvas.settings.range, Scale::cyclic)];
    canvas.list.AddQuadFilled(at(first, radius), at(last, radius), at(last, 0.55 * radius),
                              at(first, 0.55 * radius), packed_colour(colour));
  }
  const auto label = [&](double angle, const char* words) {
    const ImVec2 size = Canvas::size_of(words);
    const ImVec2 place = at(angle, radius + 0.5 * size.x + 4 * canvas.unit());
    canvas.text(place.x - 0.5 * size.x, place.y - 0.5 * size.y, words);
  };
  label(0, "0°");
  label(std::numbers::pi / 2, "90°");
  label(std::numbers::pi, "180°");
  label(-std::numbers::pi / 2, "−90°");
}

class LegendList {
 public:
  LegendList(const Canvas& canvas, double x, double y) : canvas_(canvas), x_(x), y_(y) {}

  void add(Special kind, const char* words, bool hatched = false) {
    add(packed_colour(canvas_.special(kind)), words, hatched);
  }
  void add(ImU32 colour, const char* words, bool hatched = false) {
    const auto side = static_cast<float>(12 * canvas_.unit());
    const auto left = static_cast<float>(x_);
    const auto top = std::round(static_cast<float>(y_ + 3 * canvas_.unit()));
    const ImVec2 corner(left + side, top + side);
    if (hatched) {
      canvas_.list.PushClipRect(ImVec2(left, top), corner, true);
      for (int line = 0; line < 5; ++line) {
        const float offset = static_cast<float>(5 * line) * canvas_.unit();
        canvas_.list.AddLine(ImVec2(left + offset, top), ImVec2(left + offset - side, top + side),
                             colour, 1.5f * canvas_.unit());
      }
      canvas_.list.PopClipRect();
    } else {
      canvas_.list.AddRectFilled(ImVec2(left, top), corner, colour);
    }
    canvas_.list.AddRect(ImVec2(left, top), corner, canvas_.faint_colour);
    canvas_.text(x_ + 20 * canvas_.unit(), y_, words);
    y_ += 20 * canvas_.unit();
  }
  [[nodiscard]] double y() const { return y_; }

 private:
  const Canvas& canvas_;
  double x_;
  double y_;
};

void write_arrow_scale(const Canvas& canvas, const SourceInfo& source, const Layout& layout,
                       double y) {
  const RenderSettings& settings = canvas.settings;
  const double pitch = arrow_pitch_mm(source);
  const std::uint32_t block = arrow_block_of(settings, layout.plot, pitch);
  const double cell_pixels = block * pitch * pixels_per_mm(settings.view, layout.plot);
  const double length = 1.5 * cell_pixels;
  const double x = layout.legend.x;
  const double middle = y + 9 * canvas.unit();
  const double head = 5 * canvas.unit();
  canvas.list.AddLine(to_imgui({x, middle}), to_imgui({x + length - head, middle}),
                      canvas.text_colour, 2 * canvas.unit());
  canvas.list.AddTriangleFilled(
      to_imgui({x + length, middle}), to_imgui({x + length - head, middle - 3 * canvas.unit()}),
      to_imgui({x + length - head, middle + 3 * canvas.unit()}), canvas.text_colour);
  const bool from_above = std::holds_alternative<TopView>(settings.view);
  const char* name = from_above ? "shear" : "force";
  const double sum = full_arrow_n(settings) * block * block;
  canvas.text(x, y + 20 * canvas.unit(),
              fmt::format("{} {}", name, settings.units.text(Dimension::force, sum)));
  canvas.text(x, y + 38 * canvas.unit(),
              block == 1 ? "on a pillar" : fmt::format("on {} × {} pillars", block, block),
              canvas.faint_colour);
}

void write_legend(const Canvas& canvas, const SourceInfo& source, const Layout& layout) {
  LegendList list(canvas, layout.legend.x, layout.legend.y);
  const RenderSettings& settings = canvas.settings;
  if (settings.quantity == Quantity::region) {
    list.add(Special::region_1, "1: four usable");
    list.add(Special::region_2, "2: three usable");
    list.add(Special::region_3, "3: two adjacent");
    list.add(Special::region_4, "4: one usable");
    list.add(Special::opposite, "two opposite");
  } else {
    const bool pillars = source.skin.has_pillars();
    const bool status = settings.quantity == Quantity::status;
    if (status) list.add(Special::determined, pillars ? "determined" : "in contact");
    if (pillars) list.add(Special::ambiguous, "ambiguous", !status && settings.hatch);
    if (pillars && status) list.add(Special::from_contact, "from contact");
    list.add(Special::saturated, "saturated");
    if (pillars) list.add(Special::inconsistent, "inconsistent");
  }
  list.add(Special::no_reading, "no reading");
  list.add(Special::idle, "no contact");
  if (count_absent_elements(source.calibration, source.skin) > 0) {
    list.add(packed_colour(background_of(settings.theme)), "no sensel");
  }
  if (settings.arrows) write_arrow_scale(canvas, source, layout, list.y() + 6 * canvas.unit());
}

void write_bar_title(const Canvas& canvas, const Layout& layout) {
  const QuantityInfo& info = info_of(canvas.settings.quantity);
  const std::string words = canvas.settings.units.title(info.title, info.dimension);
  const double right = layout.legend.x + layout.legend.width - 6 * canvas.unit();
  const double x = std::min(layout.bar.x, right - Canvas::size_of(words).x);
  canvas.text(x, layout.bar.y - 28 * canvas.unit(), words);
}

/// Colour bar or wheel, and the legend.
void write_scales(const Canvas& canvas, const SourceInfo& source, Layout layout) {
  write_bar_title(canvas, layout);
  const Scale scale = info_of(canvas.settings.quantity).scale;
  if (scale == Scale::cyclic) {
    write_wheel(canvas, layout);
  } else if (scale != Scale::classes) {
    write_bar(canvas, layout);
  } else {
    layout.legend.y = layout.bar.y;  // The legend replaces the bar.
  }
  write_legend(canvas, source, layout);
}

}  // namespace

void write_overlay(const GuiContext& gui, const ShownField& field, const SourceInfo& source,
                   const RenderSettings& settings, const Layout& layout, vk::Extent2D size) {
  gui.use();
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = ImVec2(static_cast<float>(size.width), static_cast<float>(size.height));
  io.DeltaTime = 1;
  ImGui::NewFrame();
  const bool dark = settings.theme == Theme::dark;
  const Canvas canvas{*ImGui::GetBackgroundDrawList(), settings,
                      dark ? IM_COL32(232, 236, 241, 255) : IM_COL32(22, 26, 32, 255),
                      dark ? IM_COL32(150, 158, 170, 255) : IM_COL32(96, 104, 116, 255)};
  draw_absent(canvas, source, Ground(&field, source, settings, layout.plot));
  const auto* const top = std::get_if<TopView>(&settings.view);
  if (settings.legend && top != nullptr) write_values(canvas, field, source, *top, layout.plot);
  if (settings.contacts && field.contacts != nullptr) {
    draw_contact_marks(*ImGui::GetBackgroundDrawList(), *field.contacts,
                       Ground(&field, source, settings, layout.plot));
  }
  if (settings.legend) {
    canvas.rectangle(layout.plot, canvas.faint_colour);
    write_title(canvas, field, source, layout);
    if (top != nullptr) {
      write_axes(canvas, *top, layout);
    } else {
      write_triad(canvas, source, layout);
      write_scale_bar(canvas, source, layout);
    }
    write_scales(canvas, source, layout);
  }
  ImGui::Render();
}

}  // namespace pillarfield::viewer
