#include "pillarfield/memory_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/number_text.h"
#include "base/quantile.h"
#include "calibration/linear_readings.h"
#include "calibration/memory_fit.h"
#include "calibration/steps.h"
#include "pillarfield/error.h"
#include "pillarfield/untouched_skin.h"

namespace pillarfield {
namespace {

/// Least number of frames, and least ratio of the largest to the mean load.
constexpr std::size_t kLeastFrames = 50;
constexpr double kLeastChange = 1.1;
/// Ends of the pieces of a fitted curve, as fractions of the largest reading.
constexpr double kPieceEnds[] = {1.0 / 64, 1.0 / 32, 1.0 / 16, 1.0 / 8, 1.0 / 4, 3.0 / 8,
                                 1.0 / 2,  5.0 / 8,  3.0 / 4,  7.0 / 8, 1};
/// A curve is fitted anew if its RMS residual is below this fraction of that of a factor.
constexpr double kNewCurveWins = 0.5;
/// Memory is found if it lowers the RMS residual below this fraction, and reads at least this much
/// of the range.
constexpr double kMemoryWins = 0.9;
constexpr double kLeastMemory = 0.002;
/// Largest reading kept at zero load, as a fraction of the threshold.
constexpr double kMostRemainder = 0.5;

using Sample = MemoryFinder::Sample;

void require_experiment(const std::vector<Sample>& samples) {
  if (samples.size() < kLeastFrames) {
    throw Error("memory", fmt::format("{} frames are too few", samples.size()),
                fmt::format("give at least {}", kLeastFrames));
  }
  double sum = 0;
  double most = 0;
  for (const Sample& sample : samples) {
    sum += sample.load_counts;
    most = std::max(most, sample.load_counts);
  }
  if (most > kLeastChange * sum / static_cast<double>(samples.size())) return;
  throw Error("memory", "the pressure does not change",
              "give frames in which it rises from zero, rests and falls");
}

bool rests_after_load(const std::vector<Sample>& samples, double zone) {
  const auto loaded =
      std::ranges::find_if(samples, [&](const Sample& s) { return s.load_counts > zone; });
  return std::any_of(loaded, samples.end(), [&](const Sample& s) { return s.load_counts <= zone; });
}

/// Throws if the skin keeps a reading at zero load, which the plays do not have. The curve would
/// take it for the reading of no load, and with it small loads.
void require_closed_loops(const std::vector<Sample>& samples, const MemoryModelling& model,
                          double most_counts) {
  const MemoryFit fit = fit_memory(samples, model);
  if (fit.remainder <= most_counts || !rests_after_load(samples, fit.dead_zone + most_counts))
    return;
  throw Error(
      "memory",
      fmt::format("after its first load the skin keeps a reading of {:.1f} counts, of which "
                  "the tare knows nothing",
                  fit.remainder),
      "press the whole skin as hard as in use, release it, and only then record the tare "
      "and all that follows");
}

/// Width of the loop at X/2 in a cycle from 0 to X, over the reading at X.
double loop_width(const SenselMemory& memory, double range) {
  double width = 0;
  double top = range;
  for (const Play& play : memory.plays) {
    const double fallen = std::min(range / 2, range - play.width_counts);
    const double risen = std::max(0.0, range / 2 - play.width_counts);
    width += play.weight * (fallen - risen);
    top += play.weight * (range - play.width_counts);
  }
  return width / top;
}

double creep_in_last_decade(const SenselMemory& memory, double duration_s) {
  double rise = 0;
  for (const Creep& creep : memory.creep) {
    rise += creep.weight *
            (std::exp(-0.1 * duration_s / creep.time_s) - std::exp(-duration_s / creep.time_s));
  }
  return rise;
}

double longest_recording(const std::vector<Sample>& samples) {
  double longest = 0;
  double duration = 0;
  for (const Sample& sample : samples) {
    duration = sample.interval_s > 0 ? duration + sample.interval_s : 0;
    longest = std::max(longest, duration);
  }
  return longest;
}

/// The reading after gain of a load that the calibration finds without its memory.
double reading_before(const SkinCalibration& calibration, double load) {
  const SensorEffects& effects = calibration.planes.effects;
  const double linear = sensel_sum(effects) * load;
  const auto& law = calibration.power_law;
  return law ? straightened({1 / law->exponent, law->reference_counts}, linear)
             : reading_at(effects.curve, linear);
}

/// The pieces of c up to a load, with the slopes that the calibration has there.
std::vector<CurveStretch> pieces_up_to(const SkinCalibration& calibration, double most) {
  std::vector<CurveStretch> pieces;
  double begin = 0;
  for (const double fraction : kPieceEnds) {
    const double end = fraction * most;
    const double width = reading_before(calibration, end) - reading_before(calibration, begin);
    pieces.push_back({end, (end - begin) / width});
    begin = end;
  }
  return pieces;
}

/// The curve of the calibration followed by c, straight on the first of its pieces.
ResponseCurve followed_by(const SkinCalibration& calibration, const MemoryFit& fit,
                          const std::vector<CurveStretch>& pieces) {
  const double sum = sensel_sum(calibration.planes.effects);
  std::vector<double> knots;
  knots.reserve(pieces.size() + calibration.planes.effects.curve.loads.size());
  for (const CurveStretch& piece : pieces) knots.push_back(piece.end);
  for (const double load : calibration.planes.effects.curve.loads) {
    if (load / sum > pieces.front().end) knots.push_back(load / sum);
  }
  std::ranges::sort(knots);
  ResponseCurve curve;
  constexpr double kLeastGap = 1.02;  // Close knots would repeat the steps of a fit.
  double last = 0;
  for (const double knot : knots) {
    const double load = sum * value_at(fit, pieces, knot);
    if (!(knot > kLeastGap * last && load > (curve.loads.empty() ? 0 : curve.loads.back()))) {
      continue;
    }
    last = knot;
    curve.readings.push_back(reading_before(calibration, knot));
    curve.loads.push_back(load);
  }
  return curve;
}

/// The typical dead zone of a calibration whose response curve was fitted with it.
std::optional<double> known_dead_zone(const Calibration& planes) {
  if (planes.effects.curve.empty()) return std::nullopt;
  std::vector<float> zones = planes.dead_zone;
  return zones.empty() ? 0 : median(zones);
}

/// `residual`: RMS over the largest load, `range`, counts.
void store(const MemoryFit& fit, const std::vector<CurveStretch>& pieces, double residual,
           double range, SkinCalibration& calibration) {
  Calibration& planes = calibration.planes;
  const bool curved = pieces.size() > 1;
  // A factor on the readings goes into k, and so into all loads.
  const double scale = curved ? 1 : fit.slopes[0];
  if (curved) {
    const ResponseCurve curve = followed_by(calibration, fit, pieces);
    set_power_law(calibration, std::nullopt);
    planes.effects.curve = curve;
  }
  *calibration.counts_per_newton /= scale;
  planes.effects.memory = fit.memory;
  for (Play& play : planes.effects.memory->plays) play.width_counts /= scale;
  planes.dead_zone.clear();
  if (fit.dead_zone > 0) {
    planes.dead_zone.assign(std::size_t{calibration.rows} * calibration.cols,
                            static_cast<float>(fit.dead_zone / scale));
  }
  ResidualError& left =
      planes.effects.residual.emplace(planes.effects.residual.value_or(ResidualError{}));
  // Half of the variance counts as constant, half as proportional.
  left.relative = std::min(1.0, std::hypot(left.relative, residual / std::numbers::sqrt2));
  left.offset_counts =
      std::hypot(left.offset_counts, residual * range / std::numbers::sqrt2) / scale;
  if (calibration.threshold_factor && !planes.noise.empty()) {
    set_threshold(calibration, *calibration.threshold_factor);
  }
}

}  // namespace

MemoryFinder::MemoryFinder(const Skin& skin, const SkinCalibration& calibration)
    : skin_(skin), calibration_(calibration) {
  require_fitting(calibration, skin, "calibration");
  if (calibration.planes.tare.empty() || !calibration.counts_per_newton) {
    throw Error("calibration", "has no tare or no counts per newton",
                "take the tare and equilibrate first");
  }
}

void MemoryFinder::add(const FrameView& frame, double time_s, double pressure_kpa) {
  const std::vector<float> readings = linear_readings(calibration_, skin_, frame);
  double sum = 0;
  std::size_t count = 0;
  for (const float reading : readings) {
    if (std::isnan(reading)) continue;
    sum += reading;
    ++count;
  }
  if (2 * count <= readings.size()) {
    throw Error("memory",
                fmt::format("{} of {} sensels can be read at {} s", count, readings.size(), time_s),
                "press less");
  }
  if (!begins_ && !(time_s > time_s_)) {
    throw Error("memory", fmt::format("the time {} s follows {} s", time_s, time_s_),
                "times must rise within a recording");
  }
  const double area_mm2 = skin_.element_pitch_mm().area_mm2();
  const double force_n = 1e-3 * pressure_kpa * area_mm2;
  const SensorEffects& effects = calibration_.planes.effects;
  samples_.push_back({begins_ ? 0 : time_s - time_s_,
                      *calibration_.counts_per_newton * force_n * pillar_sum(effects),
                      sum / static_cast<double>(count) / sensel_sum(effects)});
  time_s_ = time_s;
  begins_ = false;
}

MemoryResult MemoryFinder::result() const {
  require_experiment(samples_);
  const double most = std::ranges::max(samples_, {}, &Sample::reading).reading;
  const double range = std::ranges::max(samples_, {}, &Sample::load_counts).load_counts;
  std::vector<CurveStretch> pieces = {{most}};
  const std::optional<double> zone = known_dead_zone(calibration_.planes);
  MemoryFit fit = fit_memory(samples_, {pieces, zone});
  const std::vector<CurveStretch> many = pieces_up_to(calibration_, most);
  require_closed_loops(samples_, {many, zone.value_or(fit.dead_zone), true, true},
                       kMostRemainder * calibration_.threshold_counts.value_or(0.02 * range));
  const MemoryFit curved = fit_memory(samples_, {many, zone});
  MemoryResult result;
  result.curved = std::sqrt(curved.squares) < kNewCurveWins * std::sqrt(fit.squares);
  if (result.curved) {
    pieces = many;
    fit = curved;
  }
  const MemoryFit none = fit_memory(samples_, {pieces, zone, false});
  const auto relative = [&](double squares) {
    return std::sqrt(squares / static_cast<double>(samples_.size())) / range;
  };
  result.memory = fit.memory;
  result.hysteresis = loop_width(fit.memory, range);
  result.creep_per_decade = creep_in_last_decade(fit.memory, longest_recording(samples_));
  result.range_counts = range;
  result.dead_zone_counts = fit.dead_zone;
  result.residual_before = relative(none.squares);
  result.residual_after = relative(fit.squares);
  result.found = result.residual_after < kMemoryWins * result.residual_before &&
                 result.hysteresis + result.creep_per_decade > kLeastMemory;
  result.calibration = calibration_;
  result.calibration.planes.effects.memory.reset();
  if (!result.found) return result;
  if (result.curved && have_neighbours(calibration_.planes.effects)) {
    throw Error("memory",
                "it changes the response curve with which the effects of neighbours were found",
                "calibrate the memory before the leak, and what follows it, anew");
  }
  store(fit, pieces, result.residual_after, range, result.calibration);
  require_untouched_idle(calibration_, result.calibration, "memory");
  return result;
}

namespace {

MemoryResult find_memory(const StepWork& work) {
  MemoryFinder finder(work.correction(work.files.front(), WireUse::loaded).skin(), work.before);
  for (std::size_t i = 0; i < work.files.size(); ++i) {
    const PressureLog& pressure = work.values.logs[i];
    finder.begin();
    work.for_each(work.files[i], [&](const FrameView& frame, double time_s) {
      finder.add(frame, time_s, pressure.at(time_s));
    });
  }
  return finder.result();
}

void report_memory(StepReport& report, const MemoryResult& result) {
  report.measure("hysteresis", result.hysteresis, "hysteresis", "% of the range, at half of it");
  report.measure("creep_per_decade", result.creep_per_decade, "creep", "% in the last decade");
  report.facts["range_counts"] = result.range_counts;
  report.measure("dead_zone_counts", result.dead_zone_counts, "dead zone", "counts");
  report.facts["curved"] = result.curved;
  report.measure("residual_before", result.residual_before, "before",
                 "% of the range, RMS without memory");
  report.measure("residual_after", result.residual_after, "after", "% of the range, RMS left");
  report.facts["stored"] = result.found;
  auto& plays = report.facts["plays"] = nlohmann::ordered_json::array();
  for (const Play& play : result.memory.plays) plays.push_back({play.width_counts, play.weight});
  auto& creep = report.facts["creep"] = nlohmann::ordered_json::array();
  for (const Creep& state : result.memory.creep) {
    creep.push_back({state.time_s, state.weight});
    report.notes.push_back(
        fmt::format("  creep of {:.2f} % with {:.3g} s", 100 * state.weight, state.time_s));
  }
  if (!result.found) report.notes.emplace_back("The readings show no memory: none is stored");
  if (result.found && result.curved) report.notes.emplace_back("The response curve is fitted anew");
  report.add_residual(result.calibration.planes.effects);
}

SkinCalibration run_memory(StepWork& work) {
  const MemoryResult result = find_memory(work);
  work.report.headline = fmt::format("Found hysteresis and creep from {} up to {:.1f} counts",
                                     counted(work.frames(), "frame"), result.range_counts);
  report_memory(work.report, result);
  work.parameters = fmt::format("hysteresis = {:.4f}, creep_per_decade = {:.4f}, residual = {:.4f}",
                                result.hysteresis, result.creep_per_decade, result.residual_after);
  return result.calibration;
}

}  // namespace

StepKind memory_step() {
  StepKind step = {
      "memory", "Hysteresis and creep, under uniform pressure that rises, rests and falls.",
      "CYCLES", "Frames from a rested skin on, under uniform pressure that changes", run_memory};
  step.uses_times = true;
  step.arguments = {StepArgument::per_file(
      "pressure", "FILE",
      "Log of the pressure of each file, in order: lines of time (s), pressure (kPa)", {})};
  step.arguments.front().kind = StepArgument::Kind::log;
  step.examples = {
      kSimulateIdle,
      kTareIdle,
      "simulate scenes/calibration/creeping_skin_pressed.toml --uncalibrated -o pressed.h5",
      "simulate scenes/calibration/creeping_skin_cycles.toml --uncalibrated -o cycles.h5",
      "calibrate equilibrate pressed.h5 --pressure-kpa 187.5 --calibration tared.h5 "
      "-o equal.h5",
      "calibrate memory cycles.h5 --pressure scenes/calibration/creeping_skin_cycles.csv "
      "--calibration equal.h5 -o memory.h5"};
  return step;
}

}  // namespace pillarfield
