#include <pybind11/stl.h>

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calibration/wire_correction.h"
#include "pillarfield/arm_calibration.h"
#include "pillarfield/bending_calibration.h"
#include "pillarfield/equilibration.h"
#include "pillarfield/error.h"
#include "pillarfield/fault_finder.h"
#include "pillarfield/leak_calibration.h"
#include "pillarfield/load_calibration.h"
#include "pillarfield/memory_calibration.h"
#include "pillarfield/shear_calibration.h"
#include "pillarfield/tare.h"
#include "pillarfield/wire_calibration.h"
#include "python/bindings.h"
#include "python/frames.h"
#include "python/signals.h"

namespace pillarfield::python {
namespace {

/// References, since Python's None is a null pointer.
using SomeFrames = std::vector<std::reference_wrapper<Frames>>;

/// Calls `add` with each frame of a source, without the crosstalk of wires that `before` knows.
template <class Add>
void for_each_frame(Frames& frames, WireCorrection& correct, Add add) {
  const std::lock_guard alone(frames.alone);
  FrameSource& source = *frames.source;
  FrameBuffer frame(source.sensel_type(), source.skin().rows, source.skin().cols);
  SignalCheck check_signals;
  for (std::uint64_t i = 0; i < source.frames(); ++i) {
    check_signals();
    const double time_s = source.read(i, frame);
    add(correct(frame.view()), time_s);
  }
}

WireCorrection correction_of(const Frames& frames, const SkinCalibration& before) {
  return {"frames", frames.source->skin(), frames.source->sensel_type(),
          before.planes.effects.wires, before.planes.tare};
}

FrameStatistics statistics_of(Frames& frames, const SkinCalibration& before) {
  require_fitting(before, frames.source->skin(), "frames");
  WireCorrection correct = correction_of(frames, before);
  FrameStatistics statistics("frames", correct.skin(), correct.type());
  for_each_frame(frames, correct, [&](const FrameView& frame, double) { statistics.add(frame); });
  return statistics;
}

std::vector<FrameStatistics> statistics_of(const SomeFrames& sources,
                                           const SkinCalibration& before) {
  std::vector<FrameStatistics> all;
  for (Frames& frames : sources) all.push_back(statistics_of(frames, before));
  return all;
}

/// What a step on unloaded skin knows: tares that are an offset behind wires stay in its frames.
SkinCalibration without_tare(SkinCalibration before) {
  before.planes.tare.clear();
  return before;
}

void require_one_each(std::size_t frames, std::size_t values, const char* what) {
  if (frames == values) return;
  throw Error("calibrate", std::string("the numbers of ") + what + " and of frames differ",
              "give one for each");
}

/// The calibration with this step in its history.
SkinCalibration with_step(SkinCalibration calibration, const char* step,
                          const SomeFrames& sources) {
  std::uint64_t frames = 0;
  for (const Frames& source : sources) frames += source.source->frames();
  calibration.history.push_back(step_done(step, {}, frames, ""));
  return calibration;
}

using Findings = std::vector<SenselFinding>;

SkinCalibration blank(const Frames& frames) {
  const FrameSource& source = *frames.source;
  SkinCalibration calibration = blank_calibration(source.skin());
  if (!source.calibration().mask.empty()) mask_missing(calibration, source.calibration().mask);
  return calibration;
}

std::pair<SkinCalibration, py::dict> tare(Frames& unloaded, const SkinCalibration& before,
                                          double threshold_factor, bool preloaded) {
  TareResult result;
  {
    const py::gil_scoped_release unlocked;
    result = take_tare(before, statistics_of(unloaded, without_tare(before)),
                       {threshold_factor, preloaded});
  }
  py::dict facts;
  facts["tare_counts"] = result.tare_counts;
  facts["noise_counts"] = result.noise_counts;
  facts["findings"] = result.findings;
  return {with_step(std::move(result.calibration), "tare", {unloaded}), facts};
}

ResponseModel response_named(const std::string& model) {
  if (model == "linear") return ResponseModel::linear;
  if (model == "curve") return ResponseModel::curve;
  throw Error("equilibrate", "'" + model + "' is no model", "give 'linear' or 'curve'");
}

std::pair<SkinCalibration, py::dict> equilibrate_with(const SomeFrames& presses,
                                                      const std::vector<double>& pressures_kpa,
                                                      const SkinCalibration& before,
                                                      const std::optional<std::string>& model,
                                                      double most_unevenness) {
  require_one_each(presses.size(), pressures_kpa.size(), "pressures");
  EquilibrationOptions options;
  if (model) options.model = response_named(*model);
  options.most_unevenness = most_unevenness;
  EquilibrationResult result;
  {
    const py::gil_scoped_release unlocked;
    const auto statistics = statistics_of(presses, before);
    std::vector<UniformPress> known;
    for (std::size_t i = 0; i < statistics.size(); ++i) {
      known.push_back({statistics[i], pressures_kpa[i]});
    }
    result = equilibrate(before, known, options);
  }
  py::dict facts;
  facts["gain_spread"] = result.gain_spread;
  facts["dead_zone_counts"] = result.dead_zone_counts;
  facts["unevenness"] = result.unevenness;
  facts["shear"] = result.shear;
  facts["nonlinearity"] = result.nonlinearity;
  facts["model"] = result.model == ResponseModel::linear ? "linear" : "curve";
  facts["findings"] = result.findings;
  return {with_step(std::move(result.calibration), "equilibrate", presses), facts};
}

std::pair<SkinCalibration, py::dict> load(const SomeFrames& loads,
                                          const std::vector<double>& loads_n,
                                          const SkinCalibration& before, bool power) {
  require_one_each(loads.size(), loads_n.size(), "loads");
  LoadResult result;
  {
    const py::gil_scoped_release unlocked;
    const auto statistics = statistics_of(loads, before);
    std::vector<KnownLoad> known;
    for (std::size_t i = 0; i < statistics.size(); ++i)
      known.push_back({statistics[i], loads_n[i]});
    result = calibrate_load(before, known, power ? LoadModel::power : LoadModel::linear);
  }
  py::dict facts;
  py::list solved;
  for (const LoadResidual& residual : result.loads) solved.append(residual.solved_n);
  facts["solved_n"] = solved;
  facts["misfit"] = result.misfit;
  facts["least_counts_per_newton"] = result.least_counts_per_newton;
  facts["most_counts_per_newton"] = result.most_counts_per_newton;
  return {with_step(std::move(result.calibration), "load", loads), facts};
}

std::pair<SkinCalibration, py::dict> shear(const SomeFrames& loads,
                                           const std::vector<std::pair<double, double>>& shears_n,
                                           const SkinCalibration& before,
                                           const std::optional<std::vector<double>>& normals_n) {
  require_one_each(loads.size(), shears_n.size(), "loads");
  if (normals_n) require_one_each(loads.size(), normals_n->size(), "normal loads");
  ShearResult result;
  {
    const py::gil_scoped_release unlocked;
    const auto statistics = statistics_of(loads, before);
    std::vector<KnownShear> known;
    for (std::size_t i = 0; i < statistics.size(); ++i) {
      known.push_back({statistics[i], shears_n[i].first, shears_n[i].second});
      if (normals_n) known.back().normal_n = (*normals_n)[i];
    }
    result = calibrate_shear(before, known);
  }
  py::dict facts;
  facts["coefficient"] = py::make_tuple(result.coefficient.x, result.coefficient.y);
  facts["standard_error"] = py::make_tuple(result.standard_error.x, result.standard_error.y);
  return {with_step(std::move(result.calibration), "shear", loads), facts};
}

std::pair<SkinCalibration, py::dict> faults(const SomeFrames& moving, const SkinCalibration& before,
                                            std::uint32_t least_frames) {
  FaultResult result;
  {
    const py::gil_scoped_release unlocked;
    WireCorrection correct = correction_of(moving.at(0), before);
    FaultOptions options;
    options.least_frames = least_frames;
    FaultFinder finder("frames", correct.skin(), correct.type(), before, options);
    for (Frames& frames : moving) {
      require_fitting(before, frames.source->skin(), "frames");
      for_each_frame(frames, correct, [&](const FrameView& frame, double) { finder.add(frame); });
    }
    result = finder.result();
  }
  py::dict facts;
  facts["findings"] = result.findings;
  facts["untested"] = result.untested;
  return {with_step(std::move(result.calibration), "faults", moving), facts};
}

std::pair<SkinCalibration, py::dict> leak(const SomeFrames& presses,
                                          const SkinCalibration& before) {
  LeakResult result;
  {
    const py::gil_scoped_release unlocked;
    WireCorrection correct = correction_of(presses.at(0), before);
    LeakFinder finder(correct.skin(), before);
    for (Frames& frames : presses) {
      require_fitting(before, frames.source->skin(), "frames");
      for_each_frame(frames, correct, [&](const FrameView& frame, double) { finder.add(frame); });
    }
    result = finder.result();
  }
  py::dict facts;
  facts["inside"] = result.leak.sensel.inside;
  facts["across"] = result.leak.sensel.across;
  facts["edge"] = result.leak.pillar.edge;
  facts["corner"] = result.leak.pillar.corner;
  facts["presses"] = result.presses;
  facts["residual_before"] = result.residual_before;
  facts["residual_after"] = result.residual_after;
  return {with_step(std::move(result.calibration), "leak", presses), facts};
}

std::pair<SkinCalibration, py::dict> memory(const SomeFrames& recordings,
                                            const std::vector<std::vector<double>>& pressures_kpa,
                                            const SkinCalibration& before) {
  require_one_each(recordings.size(), pressures_kpa.size(), "lists of pressures");
  MemoryResult result;
  {
    const py::gil_scoped_release unlocked;
    WireCorrection correct = correction_of(recordings.at(0), before);
    MemoryFinder finder(correct.skin(), before);
    for (std::size_t i = 0; i < recordings.size(); ++i) {
      Frames& frames = recordings[i];
      const FrameSource& source = *frames.source;
      require_fitting(before, source.skin(), "frames");
      require_one_each(source.frames(), pressures_kpa[i].size(), "pressures");
      finder.begin();
      std::size_t index = 0;
      for_each_frame(frames, correct, [&](const FrameView& frame, double time_s) {
        finder.add(frame, time_s, pressures_kpa[i][index++]);
      });
    }
    result = finder.result();
  }
  py::dict facts;
  facts["found"] = result.found;
  facts["hysteresis"] = result.hysteresis;
  facts["creep_per_decade"] = result.creep_per_decade;
  facts["residual_before"] = result.residual_before;
  facts["residual_after"] = result.residual_after;
  return {with_step(std::move(result.calibration), "memory", recordings), facts};
}

std::pair<SkinCalibration, py::dict> bending(
    const SomeFrames& shapes, const std::vector<std::pair<double, double>>& cylinders,
    const SkinCalibration& before) {
  require_one_each(shapes.size(), cylinders.size(), "cylinders");
  BendingResult result;
  {
    const py::gil_scoped_release unlocked;
    const auto statistics = statistics_of(shapes, without_tare(before));
    std::vector<BentSkin> known;
    for (std::size_t i = 0; i < statistics.size(); ++i) {
      const auto& [radius_mm, axis_deg] = cylinders[i];
      known.push_back({statistics[i], curvature_of_cylinder(radius_mm, axis_deg)});
    }
    result = calibrate_bending(before, known);
  }
  py::dict facts;
  facts["found"] = result.found;
  facts["residual_before"] = result.residual_before;
  facts["residual_after"] = result.residual_after;
  return {with_step(std::move(result.calibration), "bending", shapes), facts};
}

std::pair<SkinCalibration, py::dict> arm(const SomeFrames& presses, const SkinCalibration& before) {
  ArmResult result;
  {
    const py::gil_scoped_release unlocked;
    result = calibrate_arm(before, statistics_of(presses, before));
  }
  py::dict facts;
  facts["found"] = result.found;
  facts["arm_mm"] = result.arm_mm;
  facts["standard_error"] = result.standard_error;
  return {with_step(std::move(result.calibration), "arm", presses), facts};
}

std::optional<TareOrigin> tares_named(const std::optional<std::string>& tares) {
  if (!tares) return std::nullopt;
  if (*tares == "conduct") return TareOrigin::conductance;
  if (*tares == "offset") return TareOrigin::offset;
  throw Error("wires", "tares is '" + *tares + "'", "give 'conduct' or 'offset'");
}

std::pair<SkinCalibration, py::dict> wires(const SomeFrames& presses, const SkinCalibration& before,
                                           std::uint32_t tile_rows, std::uint32_t tile_cols,
                                           const std::optional<std::string>& tares) {
  const std::optional<TareOrigin> origin = tares_named(tares);
  SkinCalibration bare = before;
  bare.planes.effects.wires.reset();
  WireResult result;
  {
    const py::gil_scoped_release unlocked;
    result = calibrate_wires(before, statistics_of(presses, bare), {tile_rows, tile_cols}, origin);
  }
  py::dict facts;
  facts["found"] = result.found;
  facts["row_per_count"] = result.wires.row_per_count;
  facts["column_per_count"] = result.wires.column_per_count;
  facts["idle_per_count"] = result.wires.idle_per_count;
  facts["tares"] = result.wires.tares == TareOrigin::offset ? "offset" : "conduct";
  facts["conducting_share"] = result.conducting_share;
  facts["residual_before"] = result.residual_before;
  facts["residual_after"] = result.residual_after;
  return {with_step(std::move(result.calibration), "wires", presses), facts};
}

void bind_finding(py::module_& module) {
  py::class_<SenselFinding>(module, "SenselFinding",
                            "A sensel that a step finds faulty or suspects.")
      .def_readonly("row", &SenselFinding::row, "sensel row")
      .def_readonly("col", &SenselFinding::col, "sensel column")
      .def_readonly("masked", &SenselFinding::masked, "treated as missing from now on")
      .def_readonly("mean_counts", &SenselFinding::mean_counts, "mean of its raw readings, counts")
      .def_property_readonly(
          "fault", [](const SenselFinding& self) { return name_of(self.fault); },
          "'stuck', 'noisy', 'saturated', ...");
}

}  // namespace

void bind_calibrate(py::module_& module) {
  bind_finding(module);
  constexpr const char* kText =
      "A step of pillarfield.calibrate: the better calibration, and facts.";
  module.def("blank_calibration", &blank, py::arg("frames"), "A calibration of the frames' size.");
  module.def("tare", &tare, py::arg("unloaded"), py::arg("before"), py::arg("threshold_factor"),
             py::arg("preloaded"), kText);
  module.def("equilibrate", &equilibrate_with, py::arg("presses"), py::arg("pressures_kpa"),
             py::arg("before"), py::arg("model"), py::arg("most_unevenness"), kText);
  module.def("load", &load, py::arg("loads"), py::arg("loads_n"), py::arg("before"),
             py::arg("power"), kText);
  module.def("shear", &shear, py::arg("loads"), py::arg("shears_n"), py::arg("before"),
             py::arg("normals_n"), kText);
  module.def("faults", &faults, py::arg("moving"), py::arg("before"), py::arg("least_frames"),
             kText);
  module.def("leak", &leak, py::arg("presses"), py::arg("before"), kText);
  module.def("memory", &memory, py::arg("recordings"), py::arg("pressures_kpa"), py::arg("before"),
             kText);
  module.def("bending", &bending, py::arg("shapes"), py::arg("cylinders"), py::arg("before"),
             kText);
  module.def("arm", &arm, py::arg("presses"), py::arg("before"), kText);
  module.def("wires", &wires, py::arg("presses"), py::arg("before"), py::arg("tile_rows"),
             py::arg("tile_cols"), py::arg("tares"), kText);
}

}  // namespace pillarfield::python
