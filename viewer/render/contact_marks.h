#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "viewer/render/ground.h"

struct ImDrawList;

namespace pillarfield::viewer {

/// Maximum number of drawn contacts, heaviest first.
inline constexpr std::size_t kMostContactsDrawn = 256;

/// Length of the arrow, pixels at scale 1, where the shear equals the normal force.
inline constexpr double kContactArrowPixels = 48;

/// Graphics of a contact, in pixels of the picture.
struct ContactMark {
  std::vector<SeenPoint> outline;  ///< of its bounding rectangle, see Ground::outline()
  SeenPoint centre;                ///< centre of pressure
  std::optional<Vec2> tip;         ///< of the shear arrow; none below 3 % of the normal force
  std::string words;               ///< "3  50.1 N": id and normal force
};

/// Marks of the kMostContactsDrawn heaviest contacts, heaviest first, without those out of sight or
/// partly behind the eye. An arrow is at most 3 kContactArrowPixels long, and no longer than the
/// diagonal of its contact or 16 pixels at scale 1.
[[nodiscard]] std::vector<ContactMark> contact_marks(const ShownContacts& contacts,
                                                     const Ground& ground);

/// "256 of 1031 contacts are drawn, the heaviest"; empty if all are drawn.
[[nodiscard]] std::string contacts_left_out(const ShownContacts& contacts);

/// Box of a label with a given lower left corner, moved into the plot.
[[nodiscard]] Viewport label_box(const std::string& words, Vec2 corner, const Viewport& plot,
                                 double scale);
/// Boxes of the labels of marks; of width 0 where all is hidden, or the label would cover that of a
/// mark before.
[[nodiscard]] std::vector<Viewport> label_boxes(const std::vector<ContactMark>& marks,
                                                const Viewport& plot, double scale);
/// Draws a label on a dark ground.
void draw_label(ImDrawList& list, const Viewport& box, const std::string& words, unsigned colour,
                double scale);

/// Draws marks into the plot, as far as no hill hides them; omits a label that would cover that of
/// a heavier contact.
void draw_contact_marks(ImDrawList& list, const ShownContacts& contacts, const Ground& ground);

}  // namespace pillarfield::viewer
