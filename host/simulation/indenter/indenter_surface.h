#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "pillarfield/indenter.h"
#include "simulation/closed_form/pillar_grid.h"
#include "simulation/indenter/random_field.h"

namespace pillarfield {

/// A shape without its roughness, in the indenter's frame.
class Relief {
 public:
  Relief() = default;
  virtual ~Relief() = default;
  Relief(const Relief&) = delete;
  Relief& operator=(const Relief&) = delete;

  /// Height above the shape's lowest point, mm; infinite outside the indenter.
  [[nodiscard]] virtual double height_mm(double x_mm, double y_mm) const = 0;

  /// Half sizes of the shape's bounding rectangle about the origin.
  [[nodiscard]] virtual PlaneVector reach_mm() const = 0;
};

/// The shape of an indenter; reads its height map, if any. Throws Error.
[[nodiscard]] std::unique_ptr<Relief> make_relief(const Indenter& indenter);

/// An indenter's surface: its shape, its roughness and its friction.
class IndenterSurface {
 public:
  /// `number`, the indenter's index in the scene, seeds roughness and friction.
  IndenterSurface(const Indenter& indenter, double pillar_pitch_mm, std::uint64_t seed,
                  std::uint64_t number);

  /// Height of the surface at a place in the indenter's frame; infinite outside the indenter.
  /// Roughness may make it negative.
  [[nodiscard]] double height_mm(double x_mm, double y_mm) const;
  [[nodiscard]] double friction(double x_mm, double y_mm) const;
  [[nodiscard]] PlaneVector reach_mm() const { return relief_->reach_mm(); }

 private:
  std::unique_ptr<Relief> relief_;
  double friction_;
  double roughness_mm_;
  double friction_variation_;
  std::optional<RandomField> roughness_;
  std::optional<RandomField> friction_field_;
};

}  // namespace pillarfield
