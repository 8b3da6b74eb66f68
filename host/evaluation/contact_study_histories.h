#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "evaluation/contact_study.h"

/// Loading histories of bodies as small as a fingertip, solved by the simulator's boundary-element
/// solver. They chose nothing: no parameter of an estimator may be tuned on them.
namespace pillarfield::contact_study {

/// The body that touches.
enum class Indenter : std::uint8_t {
  sphere,
  fingertip,    ///< an ellipsoid
  cylinder,     ///< lying, its ends rounded
  punch,        ///< flat, its edge rounded
  rough_ball,   ///< a sphere with a self-affine roughness, its friction varies by 10 %
  key,          ///< the height map of scenes/key.toml
  two_fingers,  ///< two ellipsoids that are dragged in opposite directions
};
inline constexpr int kIndenters = 7;

/// What it does.
enum class Loading : std::uint8_t {
  slide,        ///< presses, is dragged until it slides
  twist,        ///< presses, is turned on the spot, and part of the way back
  turn,         ///< is dragged until it slides, then at right angles to that
  reverse,      ///< is dragged until it slides, then back until it slides
  swing,        ///< slides while the load rises and falls
  grow,         ///< slides while the load rises
  fall,         ///< slides while the load falls
  touch_again,  ///< slides, lifts off, touches again at another load, and slides again
};
inline constexpr int kLoadings = 8;

[[nodiscard]] const char* name_of(Indenter indenter);
[[nodiscard]] const char* name_of(Loading loading);

/// One body, or two, from its first touch on.
struct History {
  Indenter indenter = Indenter::sphere;
  Loading loading = Loading::slide;
  double radius_pillars = 5;  ///< of a circle with the area of the contact, nearly
  double friction = 1;        ///< of all its bodies
  double direction_deg = 0;   ///< of the drag
  std::uint64_t seed = 1;

  [[nodiscard]] std::string name() const;  ///< "fingertip 8, slide to 98°, mu 2.2"
};

/// The list: each indenter at each friction of 0.8, 1.2, 1.6, 2.2, 3.0, 4.5 and with each loading,
/// contact radii of 3, 5, 8, 12, 16, 22 pillars.
[[nodiscard]] const std::vector<History>& histories();

/// 8 to 12 frames of 8-bit readings; the largest of a flawless sensor is 150 counts, the noise 0.5,
/// the threshold 2. `scenes` is the folder with key.png. Seconds for the largest. Throws Error.
[[nodiscard]] Recording record(const History& history, const std::filesystem::path& scenes);

}  // namespace pillarfield::contact_study
