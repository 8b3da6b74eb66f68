#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "pillarfield/scene.h"
#include "simulation/body/body_path.h"
#include "simulation/body/body_surface.h"
#include "simulation/body/cells.h"
#include "simulation/body/friction_contact.h"
#include "simulation/body/half_space.h"
#include "simulation/body/normal_contact.h"

namespace pillarfield {

/// What a body does to one pillar, newtons; the signs are those of ForceField.
struct BodyForce {
  std::size_t pillar;  ///< row times columns plus column
  double shear_x;
  double shear_y;
  double normal;
};
using BodyForces = std::vector<BodyForce>;

/// The forces of a body on the pillars, frame by frame. A frame depends on those before it, which
/// are solved when one is asked for and kept, so the order of the calls does not matter. Several
/// threads may call at once.
class BodyHistory {
 public:
  /// Reads the height map. `number` counts the scene's bodies from 0; the scene is checked.
  BodyHistory(const Scene& scene, std::size_t number);

  /// Of a frame, in order of pillars; what lies outside the skin is left out. Throws Error where
  /// the contact cannot be solved, and where is_interrupted().
  [[nodiscard]] std::shared_ptr<const BodyForces> forces(std::uint64_t frame);

 private:
  using SharedForces = std::shared_ptr<const BodyForces>;

  [[nodiscard]] SharedForces solved(std::uint64_t frame) const;
  [[nodiscard]] SharedForces next_frame();
  void step_to(const BodyKey& pose);
  [[nodiscard]] NormalContact press(const BodyKey& pose);
  [[nodiscard]] CellVectors rub(const BodyKey& pose, const NormalContact& normal);
  [[nodiscard]] CellVectors drive(const BodyKey& pose, const CellBox& contact);
  void add_elastic_shear(CellVectors& drive_mm, const BodyKey& pose);
  [[nodiscard]] BodyForces on_pillars(const NormalContact& normal, const CellVectors& shear) const;
  [[nodiscard]] std::string place(const BodyKey& pose) const;

  Body body_;
  std::size_t number_;
  double rate_hz_;
  std::uint64_t last_frame_;  ///< from which on nothing changes
  std::uint32_t pillar_rows_;
  std::uint32_t pillar_cols_;
  CellGrid grid_;
  double traction_to_force_n_;  ///< of one cell, from a traction over πE*
  BodySurface surface_;

  mutable std::mutex frames_mutex_;   ///< of `frames_`
  std::vector<SharedForces> frames_;  ///< those that are solved, from 0
  std::mutex solving_mutex_;          ///< of all that follows
  HalfSpaces half_spaces_;
  BodyKey pose_;       ///< of the step before
  CellVectors shear_;  ///< of the step before; its box is empty where nothing was sheared
  bool touches_ = false;
  SharedForces forces_;  ///< of the step before
};

}  // namespace pillarfield
