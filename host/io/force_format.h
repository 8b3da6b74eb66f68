#pragma once

#include "pillarfield/skin.h"

// Names in a force file that several files of code share (docs/formats.md).
namespace pillarfield::force_format {

inline constexpr const char* kName = "pillarfield-forces";
inline constexpr int kVersion = 3;
inline constexpr int kSparseSince = 2;  ///< planes may lack chunks
inline constexpr int kLayoutSince = 3;  ///< the skin may lack pillars

inline constexpr const char* kUnit = "unit";

/// Name of the pitch of elements, in all formats.
[[nodiscard]] constexpr const char* pitch_of(SkinLayout layout) {
  return layout == SkinLayout::pillars ? "pillar_pitch_mm" : "sensel_pitch_mm";
}

inline constexpr const char* kForce = "/force";
inline constexpr const char* kTime = "/force/time";
inline constexpr const char* kStatus = "/force/status";
inline constexpr const char* kUncertainty = "/uncertainty";

inline constexpr const char* kContacts = "/contacts";
inline constexpr const char* kPatch = "/contacts/patch";
inline constexpr const char* kEnded = "/contacts/ended";
/// First row and number of rows of a frame in /contacts and in /contacts/ended.
inline constexpr const char* kPatchRows[] = {"first_contact", "contacts", "first_ended", "ended"};
inline constexpr const char* kMinimumPillars = "minimum_pillars";
inline constexpr const char* kGivenFriction = "given_friction";
inline constexpr const char* kReach = "reach_mm";

}  // namespace pillarfield::force_format
