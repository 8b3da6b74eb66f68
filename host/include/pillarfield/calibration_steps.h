// The steps that calibrate a skin, in C++: what each takes, and what it finds.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pillarfield/frame.h"
#include "pillarfield/frame_statistics.h"
#include "pillarfield/sensel_finding.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield {

/// Frames under a uniform pressure without shear.
struct UniformPress {
  const FrameStatistics& frames;
  double pressure_kpa;
};

/// The relation of readings and uniform pressure.
enum class ResponseModel : std::uint8_t {
  linear,  ///< a straight line for each sensel, with its own dead zone
  curve,   ///< a ResponseCurve and a dead zone that all sensels share, and a gain for each
};

/// Options of equilibrate().
struct EquilibrationOptions {
  /// Unset: the curve if it leaves less than 0.8 of the linear residual on held-out pressures,
  /// which takes three pressures.
  std::optional<ResponseModel> model = {};
  /// Largest accepted relative standard deviation of the pressure from pillar to pillar.
  double most_unevenness = 0.1;
};

/// The result of equilibrate().
struct EquilibrationResult {
  SkinCalibration calibration;
  std::vector<SenselFinding> findings;  ///< all masked
  std::size_t levels = 0;               ///< number of different pressures
  double gain_spread = 0;               ///< relative standard deviation of gains, good sensels
  double dead_zone_counts = 0;          ///< median of the good sensels
  /// Relative standard deviation from pillar to pillar, of the pressure or of gains that neighbours
  /// share, beyond what the spread of single sensels explains.
  double unevenness = 0;
  /// Tangential over normal force of the whole press. It is the relative error of the gains.
  double shear = 0;
  /// Relative RMS residual of the fits of the model; 0 with fewer than three pressures.
  double nonlinearity = 0;
  ResponseModel model = ResponseModel::linear;
  /// Relative RMS residual on each pressure between the lowest and the highest, left out of the
  /// fit; unset with fewer than three pressures, or where the sensels share no response.
  std::optional<double> held_out_linear;
  std::optional<double> held_out_curve;
};

/// Least number of frames per press.
inline constexpr std::uint32_t kLeastPressFrames = 5;

/// Fits the gain of each sensel (mean 1), the counts per newton and, with at least two pressures,
/// the dead zones, from raw − tare = g·f(max(0, V − z)) with V = k · pressure · area of a pillar
/// and f linear or the inverse of a response curve that all sensels share. Known effects of
/// neighbours of `before` count. Masks sensels that respond not at all or unlike the others.
/// Replaces the response curve and the residual error; a curve replaces the power law. `before`
/// must have a tare; everything else of it is kept. Formulas and limits: docs/calibration.md.
/// Throws Error if the pressure is not uniform, too low or too high.
[[nodiscard]] EquilibrationResult equilibrate(const SkinCalibration& before,
                                              std::span<const UniformPress> presses,
                                              const EquilibrationOptions& options);

/// Frames of the skin under bodies at rest with a known total normal force.
struct KnownLoad {
  const FrameStatistics& frames;
  double load_n;
};

/// The relation of readings and load.
enum class LoadModel : std::uint8_t {
  linear,  ///< proportional
  power,   ///< a PowerLaw; needs two different loads
};

/// The residual of one load.
struct LoadResidual {
  double load_n = 0;
  double solved_n = 0;          ///< total normal force with the new calibration
  double ambiguous_share = 0;   ///< fraction of solved_n on ambiguous pillars
  std::uint64_t saturated = 0;  ///< pillars with a saturated sensel; their force is too small
};

/// The result of calibrate_load().
struct LoadResult {
  SkinCalibration calibration;
  std::vector<LoadResidual> loads;  ///< in the order given
  double misfit = 0;                ///< relative RMS of solved − load
  /// Counts per newton if all ambiguous pillars had the lower, or the upper, end of their segments.
  double least_counts_per_newton = 0;
  double most_counts_per_newton = 0;
};

/// Fits the counts per newton and, for LoadModel::power, the exponent, so that the solved normal
/// forces add up to the known loads. Averages the frames of a load first. Replaces the power law of
/// `before`, or removes it for LoadModel::linear, raises the residual error to what several loads
/// leave, and keeps everything else. Formulas and limits:
/// docs/calibration.md. Throws Error if the frames of a load show no contact or the loads do not
/// determine the fit.
[[nodiscard]] LoadResult calibrate_load(const SkinCalibration& before,
                                        std::span<const KnownLoad> loads, LoadModel model);

/// Frames of the skin under a body at rest with a known total tangential force on the skin.
struct KnownShear {
  const FrameStatistics& frames;
  double shear_x_n = 0;  ///< + right
  double shear_y_n = 0;  ///< + up
  /// Total normal force. If set, the solved shear is scaled by it over the solved normal force, so
  /// that errors of k and creep, which both share, cancel.
  std::optional<double> normal_n = {};
};

/// The sums of one tangential load.
struct ShearSum {
  double shear_x_n = 0;  ///< solved with the new coefficient
  double shear_y_n = 0;
  double ambiguous_share = 0;  ///< fraction of the normal force on ambiguous pillars
};

/// The result of calibrate_shear().
struct ShearResult {
  SkinCalibration calibration;
  ShearCoefficient coefficient;     ///< an axis without a load has that of the other one
  ShearCoefficient standard_error;  ///< from noise, residual error and the scatter of the loads
  std::vector<ShearSum> loads;      ///< in the order given
};

/// Fits the shear coefficients c_x and c_y so that the solved shear adds up to the known loads, by
/// least squares. Averages the frames of a load first. Stores no coefficient if both lie within two
/// standard errors of 1. `before` must have the counts per newton; everything else of it is kept.
/// Formulas and limits: docs/calibration.md. Throws Error if the frames of a load show no contact,
/// if all loads are zero or if a coefficient is out of range.
[[nodiscard]] ShearResult calibrate_shear(const SkinCalibration& before,
                                          std::span<const KnownShear> loads);

/// The result of calibrate_arm().
struct ArmResult {
  SkinCalibration calibration;
  double arm_mm = 0;          ///< of the fit; stored only if `found`
  double standard_error = 0;  ///< of arm_mm, relative
  bool found = false;         ///< arm_mm is significant; otherwise no arm is stored
  double longest_mm = 0;      ///< longest arm that would be significant
  std::uint64_t pillars = 0;  ///< region 1 pillars that were used
  std::uint64_t places = 0;   ///< contacts
  double shear_before_n = 0;  ///< RMS solved shear component of these pillars, N
  double shear_after_n = 0;   ///< what the arm leaves of it
};

/// Fits the arm of off-centre pressure (SensorEffects::arm_mm) to bodies that press straight down:
/// what their region 1 pillars read as shear is the lean of the pressure over the arm. Averages the
/// frames of each file first; each contact in it is a place. Stores no arm if its inverse lies
/// within three standard errors of zero. Replaces the arm of `before`, which must have a tare;
/// everything else of it is kept. Formulas and limits: docs/calibration.md. Throws Error if too few
/// pillars are pressed or if the standard error is above kMostArmError.
[[nodiscard]] ArmResult calibrate_arm(const SkinCalibration& before,
                                      std::span<const FrameStatistics> presses);

/// Largest standard error of an arm, relative.
inline constexpr double kMostArmError = 0.1;

/// Leaks and their standard errors.
struct LeakEstimate {
  SenselLeak sensel;
  PillarLeak pillar;
};

/// The result of LeakFinder.
struct LeakResult {
  SkinCalibration calibration;
  LeakEstimate leak;
  LeakEstimate standard_error;
  bool inside_known = false;  ///< whether a pressed pillar had an inactive sensel; else inside is 0
  std::uint64_t presses = 0;  ///< isolated pillars in all frames that were used
  std::uint64_t left_out = 0;  ///< presses whose neighbours read unlike those of the others
  std::uint64_t places = 0;    ///< different pillars
  /// RMS reading of the sensels that carry no load, relative to the mean of the pressed pillar's,
  /// before and after the correction.
  double residual_before = 0;
  double residual_after = 0;
};

/// Finds the leaks between sensels and between pillars from a fine tip on single pillars
/// (docs/calibration.md).
///
/// Around an isolated pressed pillar the sensels read only leak. Memory: 152 bytes for each press,
/// at most kMostLeakPresses.
class LeakFinder {
 public:
  /// Throws Error if the calibration is of another skin or has no tare and noise.
  LeakFinder(const Skin& skin, const SkinCalibration& calibration);

  /// Adds a frame of the skin's size. Frames without an isolated pressed pillar count for nothing.
  void add(const FrameView& frame);

  /// The leaks so far. They replace those of the calibration, unless both of a kind lie within
  /// three standard errors of zero, and so do the counts per newton and the gains at the skin's
  /// edge, which contain a part of the leaks (rescale_for_leaks()). Throws Error without isolated
  /// pillars.
  [[nodiscard]] LeakResult result() const;

 private:
  /// Readings of the 3 x 3 pillars around a pressed one.
  struct Press {
    std::uint32_t pillar;
    std::array<float, 36> readings;
  };
  class Fit;
  [[nodiscard]] bool is_isolated(std::int64_t row, std::int64_t col) const;

  Skin skin_;
  SkinCalibration calibration_;
  double noise_;
  std::vector<double> sums_;  ///< of the pillars of the last frame
  std::vector<Press> presses_;
};

inline constexpr std::size_t kMostLeakPresses = 20000;

/// Replaces the leaks, and adapts counts per newton, dead zones, widths of plays and gains found
/// with the old ones:
/// under a uniform load a sensel reads 1 + 2 inside + 2 across times more, less across at the
/// skin's edge, and a pillar carries 1 + 4 edge + 4 corner times more.
void rescale_for_leaks(SkinCalibration& calibration, const Skin& skin,
                       const std::optional<SenselLeak>& sensel,
                       const std::optional<PillarLeak>& pillar);

/// The result of MemoryFinder.
struct MemoryResult {
  SkinCalibration calibration;
  bool found = false;           ///< whether the memory explains the readings significantly better
  SenselMemory memory;          ///< fitted, whether found or not
  double hysteresis = 0;        ///< width of its loop at half the range, as a fraction of the range
  double creep_per_decade = 0;  ///< its rise from a tenth of the longest recording to all of it
  double range_counts = 0;      ///< largest V of the experiment
  double dead_zone_counts = 0;  ///< common to all sensels
  bool curved = false;          ///< whether the response curve is fitted again
  /// RMS of the reading of the whole skin minus that of the model, as a fraction of the range:
  /// without memory and with it.
  double residual_before = 0;
  double residual_after = 0;
};

/// Finds hysteresis and creep from uniform pressure that rises, rests and falls in a known way
/// (docs/calibration.md). Memory: 32 bytes a frame.
class MemoryFinder {
 public:
  /// Throws Error if the calibration is of another skin or has no tare or counts per newton.
  MemoryFinder(const Skin& skin, const SkinCalibration& calibration);

  /// Begins a recording, before which the skin has rested.
  void begin() { begins_ = true; }

  /// Adds a frame of the skin's size under a pressure, kPa. Throws Error if less than half of the
  /// sensels can be read, or the time does not rise.
  void add(const FrameView& frame, double time_s, double pressure_kpa);

  /// The memory so far. If found, it replaces that of the calibration, the dead zones become a
  /// common one, and k or the response curve follow, since `equilibrate` took a part of the memory
  /// for sensitivity. Throws Error if the frames are too few or the pressure does not change.
  [[nodiscard]] MemoryResult result() const;

  /// The mean reading and the load of a frame.
  struct Sample {
    double interval_s;   ///< since the frame before; 0 in the first one of a recording
    double load_counts;  ///< k · pressure · area of a pillar · pillar_sum()
    double reading;      ///< after tare, gain, curve and neighbours
  };

 private:
  Skin skin_;
  SkinCalibration calibration_;
  bool begins_ = true;
  double time_s_ = 0;
  std::vector<Sample> samples_;
};

/// Curvature around a cylinder of this radius, mm (below zero: inside of one), whose axis has the
/// angle axis_deg from +x, counter-clockwise: (sin² a, cos² a, −2 sin a cos a) / radius.
[[nodiscard]] Curvature curvature_of_cylinder(double radius_mm, double axis_deg);

/// Frames of the skin on a known shape, with nothing touching it.
struct BentSkin {
  const FrameStatistics& frames;
  Curvature curvature;
};

/// The result of calibrate_bending().
struct BendingResult {
  SkinCalibration calibration;
  bool found = false;             ///< whether the patterns exceed their errors
  double rms[3] = {};             ///< of bend_x, bend_y, bend_xy over the good sensels, counts·mm
  double standard_error[3] = {};  ///< of a sensel's bend_x, bend_y, bend_xy, RMS, counts·mm
  double residual_before = 0;     ///< RMS of the tare's change over sensels and shapes, counts
  double residual_after = 0;      ///< what the patterns leave of it
};

/// Fits the patterns Calibration::bend_x, bend_y and bend_xy: mean − tare = bend_x·x + bend_y·y +
/// bend_xy·xy, by least squares over the shapes. bend_xy is zero if no shape has a curvature xy.
/// Stores none if their mean square is below 1.2 times that of their errors. `before` must have the
/// tare of the flat skin and its noise; everything but the patterns is kept. Formulas and limits:
/// docs/calibration.md. Throws Error if the shapes do not determine the patterns, or sensels are at
/// full scale.
[[nodiscard]] BendingResult calibrate_bending(const SkinCalibration& before,
                                              std::span<const BentSkin> shapes);

/// Sensels that share wires.
struct WireTile {
  std::uint32_t rows = 64;  ///< 2..1024
  std::uint32_t cols = 64;
};

/// The result of calibrate_wires().
struct WireResult {
  SkinCalibration calibration;  ///< blank but for the wires, and the mask of `before`
  WireCrosstalk wires;
  WireCrosstalk standard_error;
  bool found = false;       ///< whether the row's or the column's exceeds three standard errors
  std::size_t sensels = 0;  ///< under the body at rest
  /// Fraction of the tares caused by conductance, near 0 or 1: how far the readings of unloaded
  /// sensels follow the loss of their wires.
  double conducting_share = 0;
  /// Origin of the tares by `conducting_share`; unset where tares or the loss are within the noise.
  std::optional<TareOrigin> tares_shown;
  /// RMS change of their readings under the other loads, as a fraction: before and after.
  double residual_before = 0;
  double residual_after = 0;
};

/// Fits the resistances of the wires. Under all of `presses` the same body rests at the same place;
/// in the first one it is alone, in the others another body presses elsewhere, in some in its rows
/// and in some in its columns. What its sensels read then changes only through the wires. Tares,
/// gains and noise of `before` were measured through the wires and are removed: measure them again.
/// `tares` says how tares arise; unset: as the readings of unloaded sensels show, or else by
/// conductance. Formulas and limits: docs/calibration.md. Throws Error without a body that rests
/// alone, or if the other loads change nothing that tells rows from columns.
[[nodiscard]] WireResult calibrate_wires(const SkinCalibration& before,
                                         std::span<const FrameStatistics> presses,
                                         const WireTile& tile,
                                         std::optional<TareOrigin> tares = std::nullopt);

}  // namespace pillarfield
