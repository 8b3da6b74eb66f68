#pragma once

#include "pillarfield/skin.h"

// Names in an HDF5 file of force fields (docs/formats.md).
namespace pillarfield::force_format {

inline constexpr const char* kName = "pillarfield-forces";
inline constexpr int kVersion = 3;
inline constexpr int kSparseSince = 2;  ///< planes may lack chunks
inline constexpr int kLayoutSince = 3;  ///< the skin may lack pillars

inline constexpr const char* kUnit = "unit";
inline constexpr const char* kSignConvention = "sign_convention";
inline constexpr const char* kEstimator = "estimator";
inline constexpr const char* kSegmentPoint = "segment_point";
inline constexpr const char* kDevice = "device";
inline constexpr const char* kSource = "source";
inline constexpr const char* kProgramVersion = "program_version";
inline constexpr const char* kLayout = "layout";  ///< "sensels", or absent
inline constexpr const char* kPillarPitch = "pillar_pitch_mm";
inline constexpr const char* kSenselPitch = "sensel_pitch_mm";  ///< without pillars

/// Name of the pitch of elements, in all formats.
[[nodiscard]] constexpr const char* pitch_of(SkinLayout layout) {
  return layout == SkinLayout::pillars ? kPillarPitch : kSenselPitch;
}

inline constexpr const char* kEffects = "/effects";
inline constexpr const char* kForce = "/force";
inline constexpr const char* kTime = "/force/time";
inline constexpr const char* kStatus = "/force/status";
inline constexpr const char* kMagnitude = "/force/magnitude";
inline constexpr const char* kPressure = "/force/pressure";
inline constexpr const char* kUncertainty = "/uncertainty";

inline constexpr const char* kFirstFrame = "first_frame";

inline constexpr const char* kContacts = "/contacts";
inline constexpr const char* kPatch = "/contacts/patch";
inline constexpr const char* kEnded = "/contacts/ended";
inline constexpr const char* kFrameColumn = "frame";
/// First row and number of rows of a frame in /contacts and in /contacts/ended.
inline constexpr const char* kPatchRows[] = {"first_contact", "contacts", "first_ended", "ended"};
inline constexpr const char* kWords = "words";
inline constexpr const char* kMinimumPillars = "minimum_pillars";
inline constexpr const char* kGivenFriction = "given_friction";
inline constexpr const char* kReach = "reach_mm";

}  // namespace pillarfield::force_format
