#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <variant>

namespace pillarfield::viewer {

struct Vec2 {
  double x = 0, y = 0;
  friend bool operator==(const Vec2&, const Vec2&) = default;
};
struct Vec3 {
  double x = 0, y = 0, z = 0;
};

/// Column by column, as GLSL: clip = matrix * (x, y, z, 1) with Vulkan's clip space (y down, z
/// 0..1).
using Matrix = std::array<float, 16>;

/// The skin as a flat sheet before it is laid on its surface: x right, y up, mm from its middle.
struct SkinSize {
  double width_mm = 0, height_mm = 0;
};

/// The surface the skin lies on: maps a point of the flat sheet to space, isometrically, with unit
/// tangents along x and y and the outward normal. The sheet's middle is the origin of space, its
/// normal there z. The same function stands in shaders/surface.glsl.
enum class SurfaceKind : std::uint32_t { plane, cylinder };
struct Surface {
  SurfaceKind kind = SurfaceKind::plane;
  double radius_mm = 0;  ///< of the cylinder, whose axis runs along y and whose crest is at x = 0;
                         ///< below kLeastRadiusMm it is a plane
  friend bool operator==(const Surface&, const Surface&) = default;
};
inline constexpr double kLeastRadiusMm = 1e-3;
struct SurfaceFrame {
  Vec3 position;                      ///< mm
  Vec3 tangent_x, tangent_y, normal;  ///< unit vectors
};
[[nodiscard]] SurfaceFrame frame_at(const Surface& surface, Vec2 point_mm);

/// From above, without perspective; y up.
struct TopView {
  Vec2 centre_mm;  ///< of the sheet, in the middle of the viewport
  double pixels_per_mm = 1;
  friend bool operator==(const TopView&, const TopView&) = default;
};
/// In perspective, around a target on the sheet. Angles are about the frame of the surface there.
struct OrbitView {
  Vec2 target_mm;
  double azimuth = 0.6;    ///< rad, about the normal; 0: from below the picture's lower edge (-y)
  double elevation = 0.9;  ///< rad above the sheet, (0, pi/2]
  double distance_mm = 300;
  double field_of_view = 0.6;  ///< rad, vertical
  friend bool operator==(const OrbitView&, const OrbitView&) = default;
};
using View = std::variant<TopView, OrbitView>;

/// A viewport in pixels from the picture's upper left corner.
struct Viewport {
  double x = 0, y = 0, width = 1, height = 1;
};

/// The whole skin in the viewport, with 4 % of the viewport's sides free at either end or more.
[[nodiscard]] TopView fit_top(const SkinSize& skin, const Viewport& viewport);
[[nodiscard]] OrbitView fit_orbit(const SkinSize& skin, const Surface& surface,
                                  const Viewport& viewport);

/// Arrows of this length from anywhere on the skin lie between the near and the far plane.
inline constexpr double kArrowRoomMm = 60;

/// What the shaders draw with. Depth is 0 at the near plane and 1 at the far one; both are as close
/// about the skin and its arrows as the eye allows. Top views ignore the surface.
[[nodiscard]] Matrix clip_from_world(const View& view, const Surface& surface, const SkinSize& skin,
                                     const Viewport& viewport);

/// Where a point in space appears, in pixels of the picture; none behind the eye.
[[nodiscard]] std::optional<Vec2> project(const View& view, const Surface& surface,
                                          const SkinSize& skin, const Viewport& viewport,
                                          Vec3 point_mm);

/// The point of the sheet under a pixel; none where the skin is not. Top views ignore the surface.
[[nodiscard]] std::optional<Vec2> pick(const View& view, const Surface& surface,
                                       const SkinSize& skin, const Viewport& viewport, Vec2 pixel);

/// Drags and wheels. `pixels` is the way of the mouse. All keep values within sensible limits.
void pan(View& view, const Viewport& viewport, Vec2 pixels);  ///< what is there follows the mouse
void orbit(View& view, Vec2 pixels);                          ///< top views stay as they are
/// `factor` above 1 enlarges. In a top view the point under `pixel` stays there.
void zoom(View& view, const Viewport& viewport, Vec2 pixel, double factor);
/// Brings the middle of the view back onto the skin.
void keep_on_skin(View& view, const SkinSize& skin);

/// Pixels that a millimetre of the sheet takes in the middle of the viewport.
[[nodiscard]] double pixels_per_mm(const View& view, const Viewport& viewport);

}  // namespace pillarfield::viewer
