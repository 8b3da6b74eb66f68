#include "pillarfield/scene.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>

#include "pillarfield/error.h"
#include "pillarfield/simulator.h"
#include "pillarfield/skin_calibration.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/force_planes.h"
#include "python/signals.h"

namespace pillarfield::python {
namespace {

constexpr const char* kScene = R"(A scene: the skin, its sensor, the frames, and what touches it.

Read it with Scene.load(path) from a TOML file (docs/scenes.md), or make it with scene(dict).)";

/// Readings and truth of frames of a scene: {"frames", "times", planes of the truth}.
py::dict render(const Simulator& simulator, std::uint64_t first, std::uint64_t count) {
  const Skin& skin = simulator.scene().skin;
  const SenselType type = simulator.sensel_type();
  py::array readings(dtype_of(type), Shape{static_cast<py::ssize_t>(count), skin.rows, skin.cols});
  auto* out = static_cast<std::byte*>(readings.mutable_data());
  const std::size_t frame_bytes = skin.sensels() * size_of(type);
  ForceStack truth(skin);
  std::vector<double> times;
  {
    const py::gil_scoped_release unlocked;
    truth.reserve(count);
    SignalCheck check_signals;
    simulator.render_all(
        first, count, [&](std::uint64_t index, const FrameView& frame, const ForceField& forces) {
          check_signals();
          out = std::copy_n(static_cast<const std::byte*>(frame.data), frame_bytes, out);
          truth.append(forces.view());
          times.push_back(simulator.time_of(index));
        });
  }
  py::dict result = truth.release();
  result["frames"] = readings;
  result["times"] = array_of(std::move(times), {static_cast<py::ssize_t>(count)});
  return result;
}

SkinCalibration simulated_calibration(const Simulator& simulator) {
  SkinCalibration calibration = blank_calibration(simulator.scene().skin);
  calibration.planes = simulator.calibration();
  return calibration;
}

}  // namespace

void bind_scene(py::module_& module) {
  py::class_<Scene>(module, "Scene", kScene)
      .def_static(
          "load", [](const std::filesystem::path& path) { return load_scene(path); },
          py::arg("path"), "Reads a scene from a TOML file.")
      .def_static(
          "parse",
          [](const std::string& text, const std::string& name) { return parse_scene(text, name); },
          py::arg("text"), py::arg("name") = "scene",
          "Reads a scene from TOML text; errors use `name` as the name of its file.")
      .def_readonly("title", &Scene::title, "its title")
      .def_readonly("skin", &Scene::skin, "its Skin")
      .def_readonly("rate_hz", &Scene::rate_hz, "frames per second")
      .def_readonly("frames", &Scene::frames, "number of frames")
      .def_readonly("seed", &Scene::seed, "of the sensor and its noise")
      .def(
          "replace",
          [](Scene scene, std::optional<std::uint32_t> frames, std::optional<std::uint64_t> seed) {
            if (frames) scene.frames = *frames;
            if (seed) scene.seed = *seed;
            return scene;
          },
          py::kw_only(), py::arg("frames") = py::none(), py::arg("seed") = py::none(),
          "A copy with another number of frames or another seed.")
      .def_readonly("warnings", &Scene::warnings, "one sentence each")
      .def("__repr__",
           [](const Scene& scene) {
             return fmt::format("<Scene '{}': {} frames of {} x {} sensels>", scene.title,
                                scene.frames, scene.skin.rows, scene.skin.cols);
           })
      .def(py::pickle(
          [](const Scene& scene) {
            return py::make_tuple(scene.text, scene.file, scene.frames, scene.seed);
          },
          [](const py::tuple& state) {
            Scene scene = parse_scene(state[0].cast<std::string>(),
                                      state[1].cast<std::filesystem::path>().string());
            scene.frames = state[2].cast<std::uint32_t>();
            scene.seed = state[3].cast<std::uint64_t>();
            return scene;
          }));
  py::class_<Simulator>(module, "Simulator", "Makes frames with exact truth from a Scene.")
      .def(py::init([](const Scene& scene) {
             const py::gil_scoped_release unlocked;
             return std::make_unique<Simulator>(scene);
           }),
           py::arg("scene"))
      .def("render", &render, py::arg("first"), py::arg("count"),
           "Readings, times and planes of the true forces of `count` frames.")
      .def_property_readonly("calibration", &simulated_calibration,
                             "the exact Calibration of the simulated sensor");
}

}  // namespace pillarfield::python
