#pragma once

#include <optional>
#include <vector>

#include "viewer/source/field_producer.h"
#include "viewer/source/selection.h"
#include "viewer/style/render_settings.h"

struct ImDrawList;

namespace pillarfield::viewer {

/// Relief of a skin in a picture.
struct Relief {
  double mm_per_newton = 0;  ///< of normal force; 0 without relief
  double most_mm = 0;
};
[[nodiscard]] Relief relief_of(const RenderSettings& settings, const SkinSize& size);

/// A pixel; hidden behind a hill or the far side of the skin.
struct SeenPoint : Vec2 {
  bool hidden = false;
};

/// Places of the sheet's points in a picture: in relief they stand on its hills. The
/// arguments must outlive it; `field` is null for a skin without relief.
class Ground {
 public:
  Ground(const ShownField* field, const SourceInfo& source, const RenderSettings& settings,
         const Viewport& plot);

  [[nodiscard]] const RenderSettings& settings() const { return *settings_; }
  [[nodiscard]] const Viewport& plot() const { return plot_; }

  /// None behind the eye.
  [[nodiscard]] std::optional<SeenPoint> seen(Vec2 sheet_mm) const;

  /// Pixel of the point `aside_mm` along the tangents from a point.
  [[nodiscard]] std::optional<Vec2> beside(Vec2 sheet_mm, Vec2 aside_mm) const;

  /// Outline of a rectangle of pillars, as an open-ended polygon; sides on a curved skin or in
  /// relief have intermediate points. Empty where a part lies behind the eye.
  [[nodiscard]] std::vector<SeenPoint> outline(const PillarRect& rect) const;

 private:
  [[nodiscard]] double height_at(Vec2 sheet_mm) const;
  [[nodiscard]] double height_of_corner(int row, int col) const;
  [[nodiscard]] Vec3 place_of(Vec2 sheet_mm, Vec2 aside_mm) const;
  [[nodiscard]] bool is_hidden(Vec2 sheet_mm, Vec3 place) const;

  const ShownField* field_;
  const SourceInfo* source_;
  const RenderSettings* settings_;
  Viewport plot_;
  Surface surface_;  ///< a plane in a top view
  SkinSize size_;
  Relief relief_;
};

/// Draws the visible parts of a closed outline.
void draw_outline(ImDrawList& list, const std::vector<SeenPoint>& outline, unsigned colour,
                  float width);

}  // namespace pillarfield::viewer
