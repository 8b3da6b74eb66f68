#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "viewer/source/field_producer.h"
#include "viewer/style/render_settings.h"

struct ImDrawList;

namespace pillarfield::viewer {

/// So many contacts are drawn at most, the heaviest.
inline constexpr std::size_t kMostContactsDrawn = 256;

/// Pixels, at scale 1, of the arrow of a shear as large as the normal force.
inline constexpr double kContactArrowPixels = 48;

/// What is drawn of a contact, in pixels of the picture.
struct ContactMark {
  std::vector<Vec2> outline;  ///< of the pillars' extent, as outline_of()
  Vec2 centre;                ///< of pressure
  std::optional<Vec2> tip;    ///< of its shear's arrow; none below 3 % of the normal force
  std::string words;          ///< "3  50.1 N": id and normal force
};

/// The heaviest kMostContactsDrawn contacts of a field, heaviest first. Of a contact that is out of
/// sight or partly behind the eye there is none. Arrows end at three times kContactArrowPixels.
[[nodiscard]] std::vector<ContactMark> contact_marks(const ShownContacts& contacts,
                                                     const SourceInfo& source,
                                                     const RenderSettings& settings,
                                                     const Viewport& plot);

/// "256 of 1031 contacts are drawn, the heaviest"; empty where all are.
[[nodiscard]] std::string contacts_left_out(const ShownContacts& contacts);

/// Draws them into the plot. A text that would cover that of a heavier contact is left out.
void draw_contact_marks(ImDrawList& list, const ShownContacts& contacts, const SourceInfo& source,
                        const RenderSettings& settings, const Viewport& plot);

}  // namespace pillarfield::viewer
