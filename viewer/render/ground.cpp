#include "viewer/render/ground.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "pillarfield/status.h"
#include "viewer/render/imgui_point.h"
#include "viewer/render/scene.h"
#include "viewer/style/surface.h"

namespace pillarfield::viewer {
namespace {

constexpr double kMostRelief = 1.5;  ///< of the height of RenderSettings::relief_full_n

}  // namespace

Relief relief_of(const RenderSettings& settings, const SkinSize& size) {
  constexpr double kShare = 0.12;
  // Its peaks lie before the far and behind the near plane.
  const double full_mm =
      std::min(kShare * std::min(size.width_mm, size.height_mm), kArrowMarginMm / kMostRelief);
  const bool raised = settings.relief && std::holds_alternative<OrbitView>(settings.view);
  return {raised ? full_mm / settings.relief_full_n : 0, kMostRelief * full_mm};
}

Ground::Ground(const ShownField* field, const SourceInfo& source, const RenderSettings& settings,
               const Viewport& plot)
    : field_(field),
      source_(&source),
      settings_(&settings),
      plot_(plot),
      size_(skin_size(source)),
      relief_(relief_of(settings, size_)) {
  if (std::holds_alternative<OrbitView>(settings.view)) surface_ = settings.surface;
  if (field == nullptr) relief_.mm_per_newton = 0;
}

/// The mean of the four pillars that meet at a corner, as shaders/relief.glsl has it.
double Ground::height_of_corner(int row, int col) const {
  const ForceFieldView& forces = field_->forces;
  double sum = 0;
  for (const auto& [r, c] : std::array{std::pair{row - 1, col - 1}, std::pair{row - 1, col},
                                       std::pair{row, col - 1}, std::pair{row, col}}) {
    if (r < 0 || c < 0 || r >= static_cast<int>(forces.rows) ||
        c >= static_cast<int>(forces.cols)) {
      continue;
    }
    const std::size_t at = static_cast<std::size_t>(r) * forces.cols + static_cast<std::size_t>(c);
    const auto normal = static_cast<double>(forces.normal[at]);
    if ((forces.status[at] & status::kLoaded) == 0 || std::isnan(normal)) continue;
    sum += std::clamp(normal * relief_.mm_per_newton, 0.0, relief_.most_mm);
  }
  return sum / 4;
}

double Ground::height_at(Vec2 sheet_mm) const {
  if (relief_.mm_per_newton == 0) return 0;
  const Skin& skin = source_->skin;
  const double col = sheet_mm.x / skin.element_pitch_mm().col_mm + 0.5 * skin.element_cols();
  const double row = 0.5 * skin.element_rows() - sheet_mm.y / skin.element_pitch_mm().row_mm;
  const double left = std::floor(col);
  const double above = std::floor(row);
  const auto corner = [&](int down, int right) {
    return height_of_corner(static_cast<int>(above) + down, static_cast<int>(left) + right);
  };
  return std::lerp(std::lerp(corner(0, 0), corner(0, 1), col - left),
                   std::lerp(corner(1, 0), corner(1, 1), col - left), row - above);
}

Vec3 Ground::place_of(Vec2 sheet_mm, Vec2 aside_mm) const {
  const Pose frame = pose_at(surface_, sheet_mm);
  return frame.position_mm + height_at(sheet_mm) * frame.normal + aside_mm.x * frame.tangent_x +
         aside_mm.y * frame.tangent_y;
}

bool Ground::is_hidden(Vec2 sheet_mm, Vec3 place) const {
  if (!std::holds_alternative<OrbitView>(settings_->view)) return false;
  const Camera camera = camera_of(settings_->view, surface_, plot_);
  const Vec3 to_eye = camera.eye - place;
  const double pitch = arrow_pitch_mm(*source_);
  if (surface_.shape != SurfaceShape::plane) {  // The skin itself is in the way.
    const Vec3 base = pose_at(surface_, sheet_mm).position_mm;
    const auto first = first_hit({camera.eye, base - camera.eye}, surface_, size_);
    return first && length(pose_at(surface_, *first).position_mm - base) > 2 * pitch;
  }
  if (relief_.mm_per_newton == 0 || !(to_eye.z > 0)) return false;
  // Towards the eye, up to the height of the highest peak.
  constexpr double kSlack = 0.02;  // of the highest peak: the mesh of the picture is coarser
  constexpr int kMostSteps = 400;
  const Vec3 step = 0.5 * pitch / length(to_eye) * to_eye;
  Vec3 at = place + 2.0 * step;
  for (int i = 0; i < kMostSteps && at.z < relief_.most_mm; ++i, at = at + step) {
    if (height_at({at.x, at.y}) > at.z + kSlack * relief_.most_mm) return true;
  }
  return false;
}

std::optional<SeenPoint> Ground::seen(Vec2 sheet_mm) const {
  const Vec3 place = place_of(sheet_mm, {});
  const auto pixel = project(settings_->view, surface_, size_, plot_, place);
  if (!pixel) return std::nullopt;
  return SeenPoint{*pixel, is_hidden(sheet_mm, place)};
}

std::optional<Vec2> Ground::beside(Vec2 sheet_mm, Vec2 aside_mm) const {
  return project(settings_->view, surface_, size_, plot_, place_of(sheet_mm, aside_mm));
}

std::vector<SeenPoint> Ground::outline(const PillarRect& rect) const {
  const Skin& skin = source_->skin;
  const auto [row_mm, col_mm] = skin.element_pitch_mm();
  const double left = (rect.col_begin - 0.5 * skin.element_cols()) * col_mm;
  const double right = (rect.col_end - 0.5 * skin.element_cols()) * col_mm;
  const double top = (0.5 * skin.element_rows() - rect.row_begin) * row_mm;
  const double bottom = (0.5 * skin.element_rows() - rect.row_end) * row_mm;
  const std::array<Vec2, 5> corners{
      {{left, top}, {right, top}, {right, bottom}, {left, bottom}, {left, top}}};
  const bool straight = surface_.shape == SurfaceShape::plane && relief_.mm_per_newton == 0;
  const int pieces = straight ? 1 : 32;
  std::vector<SeenPoint> points;
  for (std::size_t side = 0; side + 1 < corners.size(); ++side) {
    const Vec2& from = corners.at(side);
    const Vec2& to = corners.at(side + 1);
    for (int i = 0; i < pieces; ++i) {
      const double share = static_cast<double>(i) / pieces;
      const auto point = seen({from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)});
      if (!point) return {};
      points.push_back(*point);
    }
  }
  return points;
}

void draw_outline(ImDrawList& list, const std::vector<SeenPoint>& outline, unsigned colour,
                  float width) {
  const bool whole = std::ranges::none_of(outline, &SeenPoint::hidden);
  std::vector<ImVec2> run;
  const auto draw = [&] {
    list.AddPolyline(run.data(), static_cast<int>(run.size()), colour,
                     whole ? ImDrawFlags_Closed : ImDrawFlags_None, width);
    run.clear();
  };
  for (std::size_t i = 0; i < outline.size() + (whole ? 0 : 1); ++i) {
    const SeenPoint& point = outline[i % outline.size()];
    if (point.hidden) {
      draw();
    } else {
      run.push_back(to_imgui(point));
    }
  }
  draw();
}

}  // namespace pillarfield::viewer
