#pragma once

#include <cstdint>
#include <memory>

#include "pillarfield/calibration.h"
#include "pillarfield/force_field.h"
#include "pillarfield/frame.h"
#include "pillarfield/scene.h"

namespace pillarfield {

/// Makes frames with exact truth from a scene: the tractions of its contacts and bodies, integrated
/// over each pillar, through the pillar model (2) and the sensor the scene describes.
///
/// Every frame depends on the scene, its seed and the frame's index alone, so frames may be made
/// in any order and from several threads at once. Bodies have a history: those frames of it that
/// were not asked for before are solved first, at about 0.1 s each, one thread for each body.
class Simulator {
 public:
  /// Draws the sensor (sensitivities, tares, dead sensels) from the scene's seed, and reads the
  /// height maps of its bodies. Throws Error.
  explicit Simulator(Scene scene);
  ~Simulator();
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;

  [[nodiscard]] const Scene& scene() const;

  /// u8 or u16 with an analogue-to-digital converter, float32 without.
  [[nodiscard]] SenselType sensel_type() const;

  /// What a faultless calibration of this sensor would find.
  [[nodiscard]] const Calibration& calibration() const;

  /// Seconds since frame 0.
  [[nodiscard]] double time_of(std::uint64_t index) const;

  /// Fills `raw` [skin rows, cols] of sensel_type() and `truth` [pillar rows, cols] (newtons; its
  /// status holds the readings the ideal model makes positive). Both are overwritten whole. Throws
  /// Error where a body's contact cannot be solved, and where is_interrupted() while it is.
  void render(std::uint64_t index, FrameBuffer& raw, ForceField& truth) const;

 private:
  struct State;
  std::unique_ptr<const State> state_;
};

}  // namespace pillarfield
