#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "pillarfield/scene.h"
#include "simulation/indenter/cells.h"
#include "simulation/indenter/friction_contact.h"
#include "simulation/indenter/half_space.h"
#include "simulation/indenter/indenter_path.h"
#include "simulation/indenter/indenter_surface.h"
#include "simulation/indenter/normal_contact.h"

namespace pillarfield {

/// Force of an indenter on one pillar, N, with signs as in ForceField, and the moments of its
/// pressure, N·mm, as in PressureMoments.
struct IndenterForce {
  std::size_t pillar;  ///< row times columns plus column
  double shear_x;
  double shear_y;
  double normal;
  double moment_x;
  double moment_y;
};
using IndenterForces = std::vector<IndenterForce>;

/// Forces of an indenter on the pillars, frame by frame. A frame depends on all earlier ones, which
/// are solved on demand and kept, so calls may come in any order. Thread-safe.
class IndenterHistory {
 public:
  /// Reads the height map. `number` counts the scene's indenters from 0; the scene is checked.
  IndenterHistory(const Scene& scene, std::size_t number);

  /// Forces of a frame, in order of pillars, without those outside the skin. Throws Error if the
  /// contact cannot be solved or is_interrupted().
  [[nodiscard]] std::shared_ptr<const IndenterForces> forces(std::uint64_t frame);

 private:
  using SharedForces = std::shared_ptr<const IndenterForces>;

  [[nodiscard]] SharedForces solved(std::uint64_t frame) const;
  [[nodiscard]] SharedForces next_frame();
  void step_to(const IndenterKey& pose);
  [[nodiscard]] NormalContact press(const IndenterKey& pose);
  [[nodiscard]] CellVectors rub(const IndenterKey& pose, const NormalContact& normal);
  [[nodiscard]] CellVectors drive(const IndenterKey& pose, const CellBox& contact);
  void add_elastic_shear(CellVectors& drive_mm, const IndenterKey& pose);
  [[nodiscard]] IndenterForces on_pillars(const NormalContact& normal,
                                          const CellVectors& shear) const;
  [[nodiscard]] std::string place(const IndenterKey& pose) const;

  Indenter indenter_;
  std::size_t number_;
  double rate_hz_;
  std::uint64_t last_frame_;  ///< last frame in which the indenter moves
  std::uint32_t pillar_rows_;
  std::uint32_t pillar_cols_;
  CellGrid grid_;
  double traction_to_force_n_;  ///< factor from a cell's traction over πE* to its force
  IndenterSurface surface_;

  mutable std::mutex frames_mutex_;   ///< guards frames_
  std::vector<SharedForces> frames_;  ///< solved frames, from 0
  std::mutex solving_mutex_;          ///< guards the members below
  HalfSpaces half_spaces_;
  IndenterKey pose_;   ///< at the last step
  CellVectors shear_;  ///< at the last step; empty box without shear
  bool touches_ = false;
  SharedForces forces_;  ///< at the last step
};

}  // namespace pillarfield
