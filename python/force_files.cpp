#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "io/file_kind.h"
#include "io/force_planes.h"
#include "pillarfield/calibration_file.h"
#include "pillarfield/force_file.h"
#include "pillarfield/solver_plan.h"
#include "python/bindings.h"
#include "python/force_planes.h"
#include "python/frames.h"
#include "python/signals.h"

namespace pillarfield::python {
namespace {

constexpr const char* kReader = "Reads a file of forces; one thread at a time.";

/// The skin of a file of forces, as far as the file tells.
Skin skin_of(const ForceFileInfo& info) {
  Skin skin;
  skin.layout = info.layout;
  const std::uint32_t side = skin.has_pillars() ? 2 : 1;
  skin.rows = side * info.rows;
  skin.cols = side * info.cols;
  skin.sensel_pitch_mm = (1.0 / side) * info.element_pitch_mm;
  skin.surface = info.surface;
  return skin;
}

class ForceReader {
 public:
  ForceReader(const std::filesystem::path& path, bool trust) {
    const py::gil_scoped_release unlocked;
    reader_ = std::make_unique<ForceFileReader>(path, ReadOptions{.trust = trust});
  }

  [[nodiscard]] const ForceFileInfo& info() const { return reader_->info(); }
  [[nodiscard]] std::uint64_t frames() const { return reader_->frames(); }
  [[nodiscard]] const std::vector<std::string>& warnings() const { return reader_->warnings(); }

  [[nodiscard]] py::dict read(const IndexRange& range) {
    range.check(reader_->frames());
    ForceStack planes(skin_of(info()));
    std::vector<double> times;
    std::vector<std::shared_ptr<FrameContacts>> contacts;
    {
      const py::gil_scoped_release unlocked;
      const std::lock_guard alone(mutex_);
      planes.reserve(range.count);
      SignalCheck check_signals;
      ForceField forces;
      for (std::size_t i = 0; i < range.count; ++i) {
        check_signals();
        times.push_back(reader_->read(range[i], forces));
        planes.append(forces.view());
        if (!info().contacts) continue;
        contacts.push_back(std::make_shared<FrameContacts>(reader_->read_contacts(range[i])));
      }
    }
    py::dict result = planes.release();
    const auto count = static_cast<py::ssize_t>(range.count);
    result["times"] = array_of(std::move(times), {count});
    if (info().contacts) result["contacts"] = std::move(contacts);
    return result;
  }

 private:
  std::unique_ptr<ForceFileReader> reader_;
  std::mutex mutex_;
};

ForceFileInfo solved_by(const SolverPlan& plan) {
  ForceFileInfo info = file_info(plan, "", "");
  set_sensor(info.contacts.emplace(), plan);
  return info;
}

/// {"shear_x_low": float32 [frames, rows, cols], ..., "normal_high": ...}.
py::dict component_ends_of(const py::dict& planes, const std::optional<ForceFileInfo>& solved_by) {
  const ForceArrays forces(planes);
  ForceFileInfo info = solved_by.value_or(ForceFileInfo{});
  info.uncertainty = true;
  info.layout = forces.layout();
  FramePlanes frame(info);
  const Shape shape = {static_cast<py::ssize_t>(forces.frames()), forces.rows(), forces.cols()};
  const std::size_t pillars = std::size_t{forces.rows()} * forces.cols();
  py::dict arrays;
  std::vector<std::pair<ResultPlane, float*>> ends;
  for (const ResultPlane& plane : frame.planes()) {
    if (plane.set != PlaneSet::component_ends) continue;
    py::array_t<float> array(shape);
    ends.emplace_back(plane, array.mutable_data());
    arrays[plane.name] = array;
  }
  const py::gil_scoped_release unlocked;
  for (std::size_t i = 0; i < forces.frames(); ++i) {
    frame.set_frame(forces.frame(i));
    for (const auto& [plane, to] : ends) std::ranges::copy(frame.of(plane), to + i * pillars);
  }
  return arrays;
}

/// Writes forces in the format of the path's extension.
void save_forces(const std::filesystem::path& path, const py::dict& planes,
                 const std::vector<double>& times,
                 const std::optional<std::vector<std::shared_ptr<FrameContacts>>>& contacts,
                 const Skin& skin, const std::optional<ForceFileInfo>& solved_by, bool overwrite) {
  const ForceArrays forces(planes);
  ForceFileInfo info = solved_by.value_or(ForceFileInfo{});
  info.rows = forces.rows();
  info.cols = forces.cols();
  info.frames = forces.frames();
  info.element_pitch_mm = skin.element_pitch_mm();
  info.layout = forces.layout();
  info.angles = planes.contains("theta");
  info.uncertainty = planes.contains("uncertainty_normal");
  info.surface = skin.surface;
  if (!contacts || !is_hdf5_name(path)) info.contacts.reset();
  if (info.contacts) info.contacts->surface = skin.surface;
  const py::gil_scoped_release unlocked;
  const auto sink = create_force_sink(path, info, overwrite ? Replace::anything : Replace::results);
  SignalCheck check_signals;
  for (std::size_t i = 0; i < forces.frames(); ++i) {
    check_signals();
    sink->append({.forces = forces.frame(i),
                  .contacts = contacts ? contacts->at(i).get() : nullptr,
                  .time_s = times.at(i),
                  .sequence = i});
  }
  sink->finish();
}

}  // namespace

void bind_force_files(py::module_& module) {
  py::class_<ForceFileInfo>(module, "SolvedBy", "How forces were solved.")
      .def(py::init(&solved_by), py::arg("plan"))
      .def_property_readonly("layout",
                             [](const ForceFileInfo& self) { return name_of(self.layout); });
  py::class_<ForceReader>(module, "ForceReader", kReader)
      .def(py::init<const std::filesystem::path&, bool>(), py::arg("path"), py::kw_only(),
           py::arg("trust") = false)
      .def_property_readonly(
          "skin", [](const ForceReader& self) { return skin_of(self.info()); },
          "Skin, as far as the file tells: size, pitch and surface.")
      .def_property_readonly(
          "estimator", [](const ForceReader& self) { return self.info().estimator; },
          "The estimator that solved it.")
      .def_property_readonly(
          "solved_by", [](const ForceReader& self) { return self.info(); },
          "what the intervals of the components depend on")
      .def_property_readonly(
          "source", [](const ForceReader& self) { return self.info().source; },
          "Name of the file of frames.")
      .def_property_readonly("warnings", &ForceReader::warnings,
                             "Warnings about the file, one sentence each.")
      .def(
          "read",
          [](ForceReader& self, std::int64_t first, std::int64_t step, std::int64_t count) {
            return self.read(IndexRange(first, step, count));
          },
          py::arg("first"), py::arg("step"), py::arg("count"),
          "Planes, times and contacts of `count` frames.")
      .def("__len__", &ForceReader::frames);
  module.def("save_forces", &save_forces, py::arg("path"), py::arg("planes"), py::arg("times"),
             py::arg("contacts"), py::arg("skin"), py::arg("solved_by"), py::arg("overwrite"),
             "Writes forces as a file.");
  module.def("component_ends", &component_ends_of, py::arg("planes"), py::arg("solved_by"),
             "Ends of the 95 % intervals of the components, as planes by name.");
  module.def(
      "kind_of",
      [](const std::filesystem::path& path) {
        const py::gil_scoped_release unlocked;
        return is_force_file(path)         ? "forces"
               : is_calibration_file(path) ? "calibration"
                                           : "frames";
      },
      py::arg("path"), "'forces', 'calibration' or 'frames': what a file seems to hold.");
}

}  // namespace pillarfield::python
