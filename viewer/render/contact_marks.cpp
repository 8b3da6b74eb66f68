#include "viewer/render/contact_marks.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "viewer/render/imgui_point.h"

namespace pillarfield::viewer {
namespace {

constexpr double kLeastRatio = 0.03;  ///< least shear / normal force with an arrow
constexpr double kMostRatio = 3;
constexpr double kLeastArrowLimit = 16;  ///< pixels at scale 1

constexpr ImU32 kEdge = IM_COL32(0, 0, 0, 200);  ///< keeps lines visible on any colour
constexpr ImU32 kLine = IM_COL32(255, 255, 255, 240);
constexpr ImU32 kForce = IM_COL32(120, 240, 200, 255);  ///< distinct from the arrows of cells

/// Bounding box of points, pixels.
Viewport box_about(const std::vector<SeenPoint>& points) {
  const auto [left, right] = std::ranges::minmax(points, {}, &SeenPoint::x);
  const auto [top, bottom] = std::ranges::minmax(points, {}, &SeenPoint::y);
  return {left.x, top.y, right.x - left.x, bottom.y - top.y};
}

bool overlap(const Viewport& a, const Viewport& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

Vec2 place_of(const ContactQuantities& contact) {
  return {contact.centre_of_pressure.x_mm, contact.centre_of_pressure.y_mm};
}

/// `longest`: limit of the arrow, pixels.
std::optional<Vec2> tip_of(const ContactQuantities& contact, const Ground& ground, double longest) {
  const double shear = std::hypot(contact.shear_x_n, contact.shear_y_n);
  if (!(contact.normal_n > 0) || shear < kLeastRatio * contact.normal_n) return std::nullopt;
  const double pixels = std::min(kContactArrowPixels * ground.settings().scale *
                                     std::min(shear / contact.normal_n, kMostRatio),
                                 longest);
  const double mm_per_newton =
      pixels / pixels_per_mm(ground.settings().view, ground.plot()) / shear;
  return ground.beside(place_of(contact),
                       {mm_per_newton * contact.shear_x_n, mm_per_newton * contact.shear_y_n});
}

/// Draws the lines of one picture.
class Brush {
 public:
  Brush(ImDrawList& list, double scale) : list_(list), unit_(static_cast<float>(scale)) {}

  void outline(const ContactMark& mark) const {
    draw_outline(list_, mark.outline, kEdge, 2.6f * unit_);
    draw_outline(list_, mark.outline, kLine, 1.2f * unit_);
  }

  void force(const ContactMark& mark) const {
    if (mark.centre.hidden) return;
    const ImVec2 centre = to_imgui(mark.centre);
    if (mark.tip) {
      arrow(mark.centre, *mark.tip, 3, IM_COL32(0, 0, 0, 255));
      arrow(mark.centre, *mark.tip, 0, kForce);
    }
    list_.AddCircleFilled(centre, 4.6f * unit_, kEdge);
    list_.AddCircleFilled(centre, 3.4f * unit_, kForce);
    list_.AddCircleFilled(centre, 1.6f * unit_, kEdge);
  }

 private:
  /// Enlarged by `more` pixels on all sides.
  void arrow(const Vec2& from, const Vec2& to, double more, ImU32 colour) const {
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    if (length < 1) return;
    const auto unit = static_cast<double>(unit_);
    const Vec2 way{(to.x - from.x) / length, (to.y - from.y) / length};
    const double head = std::min(11 * unit, length) + more * unit;
    const double half = 0.45 * head + 0.3 * more * unit;
    const Vec2 tip{to.x + more * unit * way.x, to.y + more * unit * way.y};
    const Vec2 neck{tip.x - head * way.x, tip.y - head * way.y};
    list_.AddLine(to_imgui(from), to_imgui(neck), colour, static_cast<float>(3 + more) * unit_);
    list_.AddTriangleFilled(to_imgui(tip), to_imgui({neck.x - half * way.y, neck.y + half * way.x}),
                            to_imgui({neck.x + half * way.y, neck.y - half * way.x}), colour);
  }

  ImDrawList& list_;
  float unit_;
};

}  // namespace

Viewport label_box(const std::string& words, Vec2 corner, const Viewport& plot, double scale) {
  const ImVec2 size = ImGui::CalcTextSize(words.c_str());
  const double width = std::ceil(static_cast<double>(size.x) + 2 * std::round(4 * scale));
  const double height = std::ceil(static_cast<double>(size.y));
  const double right = std::max(plot.x, plot.x + plot.width - width);
  const double bottom = std::max(plot.y, plot.y + plot.height - height);
  return {std::round(std::clamp(corner.x, plot.x, right)),
          std::round(std::clamp(corner.y - height, plot.y, bottom)), width, height};
}

std::vector<Viewport> label_boxes(const std::vector<ContactMark>& marks, const Viewport& plot,
                                  double scale) {
  std::vector<Viewport> labels;
  for (const ContactMark& mark : marks) {
    Viewport label{0, 0, 0, 0};
    if (!mark.centre.hidden || !std::ranges::all_of(mark.outline, &SeenPoint::hidden)) {
      const Viewport box = box_about(mark.outline);
      const double top = std::min(box.y, mark.centre.y - 6 * scale);  // Above its hill.
      label = label_box(mark.words, {box.x, top - 3 * scale}, plot, scale);
      const auto covers = [&](const Viewport& other) { return overlap(label, other); };
      if (std::ranges::any_of(labels, covers)) label.width = 0;
    }
    labels.push_back(label);
  }
  return labels;
}

void draw_label(ImDrawList& list, const Viewport& box, const std::string& words, unsigned colour,
                double scale) {
  list.AddRectFilled(to_imgui({box.x, box.y}), to_imgui({box.x + box.width, box.y + box.height}),
                     IM_COL32(8, 10, 14, 190), static_cast<float>(3 * scale));
  list.AddText(to_imgui({box.x + std::round(4 * scale), box.y}), colour, words.c_str());
}

std::vector<ContactMark> contact_marks(const ShownContacts& contacts, const Ground& ground) {
  std::vector<ContactMark> marks;
  const std::size_t count = std::min(contacts.heaviest.size(), kMostContactsDrawn);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = contacts.heaviest[i];
    const TrackedContact& contact = contacts.found.contacts[place];
    const ContactQuantities& quantities = contact.quantities;
    auto outline = ground.outline(contacts.extents[place]);
    if (outline.empty() || !overlap(box_about(outline), ground.plot())) continue;
    const auto centre = ground.seen(place_of(quantities));
    if (!centre) continue;
    const Viewport box = box_about(outline);
    const double longest =
        std::max(std::hypot(box.width, box.height), kLeastArrowLimit * ground.settings().scale);
    marks.push_back(
        {std::move(outline), *centre, tip_of(quantities, ground, longest),
         fmt::format("{}  {}", contact.track_id,
                     ground.settings().units.text(Dimension::force, quantities.normal_n))});
  }
  return marks;
}

std::string contacts_left_out(const ShownContacts& contacts) {
  if (contacts.heaviest.size() <= kMostContactsDrawn) return {};
  return fmt::format("{} of {} contacts are drawn, the heaviest", kMostContactsDrawn,
                     contacts.heaviest.size());
}

void draw_contact_marks(ImDrawList& list, const ShownContacts& contacts, const Ground& ground) {
  const auto marks = contact_marks(contacts, ground);
  const Viewport& plot = ground.plot();
  const double scale = ground.settings().scale;
  const Brush brush(list, scale);
  list.PushClipRect(to_imgui({plot.x, plot.y}),
                    to_imgui({plot.x + plot.width, plot.y + plot.height}));
  for (const ContactMark& mark : marks) brush.outline(mark);
  for (const ContactMark& mark : marks) brush.force(mark);
  const std::vector<Viewport> labels = label_boxes(marks, plot, scale);
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (labels[i].width > 0) draw_label(list, labels[i], marks[i].words, kLine, scale);
  }
  if (const std::string warning = contacts_left_out(contacts); !warning.empty()) {
    const double gap = 4 * scale;
    const Vec2 corner{plot.x + gap, plot.y + plot.height - gap};
    draw_label(list, label_box(warning, corner, plot, scale), warning, kLine, scale);
  }
  list.PopClipRect();
}

}  // namespace pillarfield::viewer
