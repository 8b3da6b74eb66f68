#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "base/range.h"
#include "pillarfield/scene.h"
#include "skin/limits.h"

namespace pillarfield {

/// A number of a scene: its key in the file, its member, and its range.
template <class Part>
struct Quantity {
  std::string_view key;
  double Part::*member;
  Range range;
};

// Keys and ranges, for reading files and for checking scenes made in code.

inline constexpr std::array<Quantity<Skin>, 2> kSkinQuantities = {{
    {"counts_per_newton", &Skin::counts_per_newton, {kMinCountsPerNewton, kMaxCountsPerNewton}},
    {"threshold_counts", &Skin::threshold_counts, {0, kMaxCounts}},
}};
inline constexpr Range kPitchMm = {1e-3, 1e3};
inline constexpr Range kFullScaleCounts = {0, kMaxCounts, true};

inline constexpr std::array<Quantity<SensorModel>, 9> kSensorQuantities = {{
    {"hysteresis", &SensorModel::hysteresis, {0, 0.3}},
    {"creep_per_decade", &SensorModel::creep_per_decade, {0, 0.3}},
    {"dead_zone_counts", &SensorModel::dead_zone_counts, {0, 1e6}},
    {"gain_spread", &SensorModel::gain_spread, {0, 0.3, false, true}},
    {"tare_counts", &SensorModel::tare_counts, {0, 1e6}},
    {"tare_spread_counts", &SensorModel::tare_spread_counts, {0, 1e6}},
    {"drift_counts_per_s", &SensorModel::drift_counts_per_s, {0, 1e6}},
    {"noise_counts", &SensorModel::noise_counts, {0, 1e6}},
    {"dead_share", &SensorModel::dead_share, {0, 1}},
}};
inline constexpr int kMaxAdcBits = 16;
inline constexpr Range kHysteresisRangeCounts = {1e-3, 1e9};
inline constexpr Range kWireOhm = {0, 1e9};
inline constexpr Range kSenselOhm = {1e-3, 1e12};
inline constexpr Range kBendSpread = {0, 1e6};
inline constexpr Range kCurvaturePerMm = {-1, 1};
inline constexpr Range kSurfaceRadiusMm = {-1e6, 1e6};
inline constexpr Range kSurfaceAxisDeg = {-360, 360};
inline constexpr Range kPowerLawExponent = {kMinExponent, kMaxExponent};
inline constexpr Range kPowerLawReference = {kMinReferenceCounts, kMaxReferenceCounts};

/// A number of a contact, and the shapes and motions to which it applies.
struct ContactQuantity {
  Quantity<ClosedFormContact> quantity;
  bool required = false;
  bool (*applies)(ContactShape shape, ContactMotion motion) = nullptr;
};

/// True if the motion has a direction.
[[nodiscard]] constexpr bool is_directed(ContactMotion motion) {
  return motion != ContactMotion::press && motion != ContactMotion::spin;
}

/// True if the motion has a stick zone.
[[nodiscard]] constexpr bool sticks(ContactMotion motion) {
  return motion == ContactMotion::partial_slip || motion == ContactMotion::roll;
}

inline constexpr std::array<ContactQuantity, 6> kContactQuantities = {{
    {{"contact_radius_mm", &ClosedFormContact::contact_radius_mm, {1e-3, 1e4}},
     true,
     [](ContactShape, ContactMotion) { return true; }},
    {{"reference_load_n", &ClosedFormContact::reference_load_n, {1e-6, 1e6}},
     false,
     [](ContactShape shape, ContactMotion) { return shape != ContactShape::flat_punch; }},
    {{"length_mm", &ClosedFormContact::length_mm, {1e-3, 1e5}},
     true,
     [](ContactShape shape, ContactMotion) { return shape == ContactShape::cylinder; }},
    {{"friction", &ClosedFormContact::friction, {0, 10}},
     true,
     [](ContactShape, ContactMotion motion) { return motion != ContactMotion::press; }},
    {{"direction_deg", &ClosedFormContact::direction_deg, {-360, 360}},
     false,
     [](ContactShape shape, ContactMotion motion) {
       return shape == ContactShape::cylinder || is_directed(motion);
     }},
    {{"tangential_ratio", &ClosedFormContact::tangential_ratio, {0, 1, true, true}},
     true,
     [](ContactShape, ContactMotion motion) { return sticks(motion); }},
}};

/// A number of an indenter, and the shapes to which it applies.
struct IndenterQuantity {
  Quantity<Indenter> quantity;
  bool required = false;
  bool (*applies)(IndenterShape shape) = nullptr;
};

/// True if an indenter of this shape has a single radius.
[[nodiscard]] constexpr bool has_radius(IndenterShape shape) {
  return shape == IndenterShape::sphere || shape == IndenterShape::cylinder ||
         shape == IndenterShape::punch;
}

inline constexpr Range kIndenterSizeMm = {1e-2, 1e4};
inline constexpr std::array<IndenterQuantity, 10> kIndenterQuantities = {{
    {{"radius_mm", &Indenter::radius_mm, kIndenterSizeMm}, true, has_radius},
    {{"length_mm", &Indenter::length_mm, kIndenterSizeMm},
     true,
     [](IndenterShape shape) { return shape == IndenterShape::cylinder; }},
    {{"edge_radius_mm", &Indenter::edge_radius_mm, {0, 1e4}},
     false,
     [](IndenterShape shape) {
       return shape == IndenterShape::cylinder || shape == IndenterShape::punch;
     }},
    {{"height_map_depth_mm", &Indenter::height_map_depth_mm, {0, 1e3, true}},
     true,
     [](IndenterShape shape) { return shape == IndenterShape::height_map; }},
    {{"roughness_um", &Indenter::roughness_um, {0, 1e4}},
     false,
     [](IndenterShape) { return true; }},
    {{"roughness_exponent", &Indenter::roughness_exponent, {0, 1, true}},
     false,
     [](IndenterShape) { return true; }},
    {{"roughness_length_mm", &Indenter::roughness_length_mm, kIndenterSizeMm},
     false,
     [](IndenterShape) { return true; }},
    {{"friction", &Indenter::friction, {0, 10}}, true, [](IndenterShape) { return true; }},
    {{"friction_variation", &Indenter::friction_variation, {0, 1}},
     false,
     [](IndenterShape) { return true; }},
    {{"friction_variation_length_mm", &Indenter::friction_variation_length_mm, kIndenterSizeMm},
     false,
     [](IndenterShape) { return true; }},
}};
inline constexpr std::int64_t kMaxSubsteps = 1000;
inline constexpr std::size_t kMaxIndenters = 100;
inline constexpr Range kModulusKpa = {1, 1e6};

inline constexpr Range kPathTimeS = {0, 1e9};
inline constexpr Range kPathPositionMm = {-1e6, 1e6};
inline constexpr Range kPathLoadN = {0, 1e6};
inline constexpr Range kPathAngleDeg = {-1e6, 1e6};

inline constexpr Range kRateHz = {1e-6, 1e6};
inline constexpr std::uint32_t kMaxFrames = 100'000'000;
inline constexpr std::uint32_t kMaxRecording = 1'000'000'000;
inline constexpr Range kParityToleranceCounts = {0, kMaxCounts};

inline constexpr Range kMaxThetaDeg = {0, 90};
inline constexpr Range kMagnitudeN = {0, 1e6, true};
inline constexpr Range kSweepFactor = {0, 1e3};
inline constexpr std::uint32_t kMaxPillars = kMaxSensels / 2;   ///< rows or columns
inline constexpr std::uint64_t kMaxMemorySensels = 10'000'000;  ///< with hysteresis or creep
inline constexpr std::uint64_t kMaxSkinSensels = 100'000'000;   ///< rows times columns: 40 m²

/// A shape or motion with its name in files.
template <class Value>
struct Named {
  std::string_view name;
  Value value;
};

inline constexpr std::array<Named<SkinLayout>, 2> kLayouts = {{
    {"pillars", SkinLayout::pillars},
    {"sensels", SkinLayout::sensels},
}};

inline constexpr std::array<Named<ContactShape>, 3> kShapes = {{
    {"sphere", ContactShape::sphere},
    {"flat_punch", ContactShape::flat_punch},
    {"cylinder", ContactShape::cylinder},
}};
inline constexpr std::array<Named<ContactMotion>, 5> kMotions = {{
    {"press", ContactMotion::press},
    {"slide", ContactMotion::slide},
    {"partial_slip", ContactMotion::partial_slip},
    {"spin", ContactMotion::spin},
    {"roll", ContactMotion::roll},
}};

inline constexpr std::array<Named<IndenterShape>, 5> kIndenterShapes = {{
    {"sphere", IndenterShape::sphere},
    {"ellipsoid", IndenterShape::ellipsoid},
    {"cylinder", IndenterShape::cylinder},
    {"punch", IndenterShape::punch},
    {"height_map", IndenterShape::height_map},
}};

inline constexpr std::array<Named<SurfaceShape>, 4> kSurfaceShapes = {{
    {"plane", SurfaceShape::plane},
    {"cylinder", SurfaceShape::cylinder},
    {"sphere", SurfaceShape::sphere},
    {"height_map", SurfaceShape::height_map},
}};

inline constexpr std::array<Named<TareOrigin>, 2> kTareOrigins = {{
    {"conduct", TareOrigin::conductance},
    {"offset", TareOrigin::offset},
}};
inline constexpr std::array<Named<Estimator>, 3> kEstimators = {{
    {"direct", Estimator::direct},
    {"paper", Estimator::paper},
    {"contact", Estimator::contact},
}};

/// True if a closed form exists for this shape and motion.
[[nodiscard]] bool is_possible(ContactShape shape, ContactMotion motion);

/// Largest value of the analogue-to-digital converter, 2^bits − 1; unset without one.
[[nodiscard]] std::optional<double> full_scale_of(const SensorModel& sensor);

/// Counts of a reading at full scale; 255 for a sensor without one.
[[nodiscard]] inline double full_scale_or_255(const Skin& skin) {
  return skin.full_scale_counts.value_or(255);
}

/// Throws Error, naming `where`, if a value of `scene` is out of range.
void check(const Scene& scene, const char* where);

}  // namespace pillarfield
