#pragma once

#include <array>
#include <cmath>
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

/// Column major: clip = matrix * (x, y, z, 1), in Vulkan's clip space (y down, z 0..1).
using Matrix = std::array<float, 16>;

/// Size of the flat sheet; its coordinates are x right, y up, mm from the middle.
struct SkinSize {
  double width_mm = 0, height_mm = 0;
};

/// The surface that the skin is drawn on: pillarfield::Surface without height maps. The middle of
/// the sheet is the origin and its normal there is z. shaders/surface.glsl holds the GLSL version.
enum class SurfaceKind : std::uint32_t { plane, cylinder, sphere };
struct Surface {
  SurfaceKind kind = SurfaceKind::plane;
  /// Radius of a cylinder or sphere, negative with the skin inside; a plane below kLeastRadiusMm.
  double radius_mm = 0;
  double axis_deg = 90;  ///< direction of a cylinder's axis, from +x towards +y
  friend bool operator==(const Surface&, const Surface&) = default;
};
inline constexpr double kLeastRadiusMm = 1e-3;
struct SurfaceFrame {
  Vec3 position;                      ///< mm
  Vec3 tangent_x, tangent_y, normal;  ///< unit vectors
};
[[nodiscard]] SurfaceFrame frame_at(const Surface& surface, Vec2 point_mm);

/// View from above without perspective; y up.
struct TopView {
  Vec2 centre_mm;  ///< sheet point in the middle of the viewport
  double pixels_per_mm = 1;
  friend bool operator==(const TopView&, const TopView&) = default;
};
/// Perspective view of a target on the sheet; angles refer to the surface frame there.
struct OrbitView {
  Vec2 target_mm;
  double azimuth = 0.6;    ///< rad, about the normal; 0: from -y
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
[[nodiscard]] constexpr bool contains(const Viewport& box, Vec2 pixel) {
  return pixel.x >= box.x && pixel.y >= box.y && pixel.x < box.x + box.width &&
         pixel.y < box.y + box.height;
}

/// The whole skin in the viewport, with a margin of at least 4 % at each side.
[[nodiscard]] TopView fit_top(const SkinSize& skin, const Viewport& viewport);
/// `view` gives the angles.
[[nodiscard]] OrbitView fit_orbit(const SkinSize& skin, const Surface& surface,
                                  const Viewport& viewport, OrbitView view = {});

/// Arrows up to this length lie between the near and the far plane.
inline constexpr double kArrowMarginMm = 60;

/// Projection for the shaders. Depth is 0 at the near plane and 1 at the far one; both enclose the
/// skin and its arrows tightly. Top views ignore the surface.
[[nodiscard]] Matrix clip_from_world(const View& view, const Surface& surface, const SkinSize& skin,
                                     const Viewport& viewport);

/// Pixel of a point in space; none behind the eye.
[[nodiscard]] std::optional<Vec2> project(const View& view, const Surface& surface,
                                          const SkinSize& skin, const Viewport& viewport,
                                          Vec3 point_mm);

/// Point of the sheet under a pixel; none beside the skin. Top views ignore the surface.
[[nodiscard]] std::optional<Vec2> pick(const View& view, const Surface& surface,
                                       const SkinSize& skin, const Viewport& viewport, Vec2 pixel);

/// Navigation by mouse movements of `pixels`, within limits.
void pan(View& view, const Viewport& viewport, Vec2 pixels);  ///< the sheet follows the mouse
void orbit(View& view, Vec2 pixels);                          ///< no effect on top views
/// `factor` above 1 enlarges; in a top view the point under `pixel` is fixed.
void zoom(View& view, const Viewport& viewport, Vec2 pixel, double factor);
/// Clamps the middle of the view to the skin.
void keep_on_skin(View& view, const SkinSize& skin);

/// Pixels per millimetre of the sheet in the middle of the viewport.
[[nodiscard]] double pixels_per_mm(const View& view, const Viewport& viewport);

[[nodiscard]] constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
[[nodiscard]] constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
[[nodiscard]] constexpr Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
[[nodiscard]] constexpr double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
[[nodiscard]] inline double length(Vec3 a) { return std::sqrt(dot(a, a)); }

}  // namespace pillarfield::viewer
