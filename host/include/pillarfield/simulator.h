#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "pillarfield/calibration.h"
#include "pillarfield/force_field.h"
#include "pillarfield/frame.h"
#include "pillarfield/scene.h"

namespace pillarfield {

/// Makes frames with exact truth from a scene: integrates the tractions of its contacts and
/// indenters over each pillar and applies the pillar model (2) and the scene's sensor.
///
/// A frame depends only on the scene, its seed and the index, so frames may be made in any order
/// and in several threads at once. Indenters have a history: render() first solves all earlier
/// frames not solved yet, about 0.1 s each, in one thread per indenter. Hysteresis and creep have
/// one too: render() of a frame before the last one starts again from frame 0.
class Simulator {
 public:
  /// Draws the sensor (sensitivities, tares, dead sensels) from the scene's seed and reads the
  /// height maps of indenters. Throws Error if the scene is out of range or a map cannot be read.
  explicit Simulator(Scene scene);
  ~Simulator();
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;

  [[nodiscard]] const Scene& scene() const;

  /// SenselType::u8 or u16 with a converter (SensorModel::adc_bits), f32 without.
  [[nodiscard]] SenselType sensel_type() const;

  /// The exact calibration of the simulated sensor.
  [[nodiscard]] const Calibration& calibration() const;

  /// Time of a frame since frame 0, s.
  [[nodiscard]] double time_of(std::uint64_t index) const;

  /// Overwrites `raw`, [sensel rows, cols] of sensel_type(), and `truth`, [pillar rows, cols], N.
  /// The status of `truth` has the bits of the sensels that its pillar loads. Throws Error if
  /// the contact of an indenter cannot be solved, or is_interrupted() becomes true meanwhile.
  void render(std::uint64_t index, FrameBuffer& raw, ForceField& truth) const;

  /// Callback of render_all(), with the index, readings and truth of a frame.
  using TakeFrame =
      std::function<void(std::uint64_t index, const FrameView& raw, const ForceField& truth)>;

  /// Renders `count` frames from `first` on in `threads` threads, the calling one included (at most
  /// 16; 0: one per processor), and calls `take` for each in order, in the calling thread. The
  /// frames are those of render(), whatever the threads. Holds `threads` + 2 frames. Throws what
  /// render() and `take` throw, after the frames before it are taken.
  void render_all(std::uint64_t first, std::uint64_t count, const TakeFrame& take,
                  unsigned threads = 0) const;

 private:
  struct State;
  std::unique_ptr<const State> state_;
};

}  // namespace pillarfield
