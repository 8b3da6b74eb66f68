#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "lab/studies/contact_study.h"

/// Test set: loading histories of indenters down to a fingertip's size, by the simulator's
/// boundary-element solver. No parameter of an estimator is chosen on it.
namespace pillarfield::contact_study {

/// Shape of the indenter.
enum class Indenter : std::uint8_t {
  sphere,
  fingertip,    ///< an ellipsoid
  cylinder,     ///< lying, rounded ends
  punch,        ///< flat, rounded edge
  rough_ball,   ///< a sphere of self-affine roughness, friction ±10 %
  key,          ///< the height map of scenes/key.toml
  two_fingers,  ///< two ellipsoids dragged in opposite directions
};
inline constexpr int kIndenters = 7;

/// Loading path of the indenter.
enum class Loading : std::uint8_t {
  slide,        ///< press, drag until full sliding
  twist,        ///< press, turn on the spot, and part of the way back
  turn,         ///< drag until full sliding, then at right angles
  reverse,      ///< drag until full sliding, then back until full sliding
  swing,        ///< slide under a load that rises and falls
  grow,         ///< slide under a rising load
  fall,         ///< slide under a falling load
  touch_again,  ///< slide, withdraw, touch again at another load, slide
};
inline constexpr int kLoadings = 8;

[[nodiscard]] const char* name_of(Indenter indenter);
[[nodiscard]] const char* name_of(Loading loading);

/// A loading history from first touch.
struct History {
  Indenter indenter = Indenter::sphere;
  Loading loading = Loading::slide;
  double radius_pillars = 5;  ///< radius of a circle of about the contact's area
  double friction = 1;        ///< of all indenters
  double direction_deg = 0;   ///< of the drag
  std::uint64_t seed = 1;

  [[nodiscard]] std::string name() const;  ///< "fingertip 8, slide to 98°, mu 2.2"
};

/// The test set: each indenter at each friction of 0.8, 1.2, 1.6, 2.2, 3.0, 4.5 and with each
/// loading; contact radii of 3, 5, 8, 12, 16, 22 pillars.
[[nodiscard]] const std::vector<History>& histories();

/// Records 8 to 12 frames of 8-bit readings: peak 150 counts, noise 0.5, threshold 2. `scenes` is
/// the folder of key.npy. Takes seconds for the largest. Throws Error.
[[nodiscard]] Recording record(const History& history, const std::filesystem::path& scenes);

}  // namespace pillarfield::contact_study
