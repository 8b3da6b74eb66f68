#include "python/frames.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <string>
#include <utility>

#include "pillarfield/error.h"
#include "pillarfield/force_file.h"
#include "python/bindings.h"
#include "python/force_planes.h"
#include "python/signals.h"

namespace pillarfield::python {
namespace {

constexpr const char* kSource =
    R"(Frames with random access: readings, times, skin and calibration.)";
constexpr const char* kOpen = R"(Opens a recording or a Tekscan ASCII export.

trust: the file comes from your own programs, so it is not examined first.)";
constexpr const char* kArray = R"(Frames of an array, without a copy.

readings: uint8, uint16 or float32 [frames, rows, cols], dense
times: float64 [frames], s
skin: Skin with constants; its rows and columns are replaced by those of the array
calibration: Calibration, or None)";

/// Frames of an array. The array must not change meanwhile.
class ArraySource final : public FrameSource {
 public:
  ArraySource(py::array readings, const py::array_t<double, py::array::forcecast>& times,
              const Skin& skin, const std::optional<SkinCalibration>& calibration)
      : readings_(std::move(readings)), type_(sensel_type_of(readings_)), skin_(skin) {
    if (readings_.ndim() != 3 || times.ndim() != 1 || times.shape(0) != readings_.shape(0)) {
      throw Error("frames", "their shape does not fit the times",
                  "give readings [frames, rows, cols] and times [frames]");
    }
    frames_ = static_cast<std::uint64_t>(readings_.shape(0));
    times_.assign(times.data(), times.data() + times.size());
    if (frames_ > 0) {
      const FrameView frame = frame_of(readings_);
      skin_.rows = frame.rows;
      skin_.cols = frame.cols;
      first_ = static_cast<const std::byte*>(frame.data);
    }
    check(skin_, "frames");
    if (!calibration) return;
    require_fitting(*calibration, skin_, "frames");
    apply(*calibration, skin_, calibration_);
  }

  [[nodiscard]] const std::string& format() const override { return format_; }
  [[nodiscard]] const Skin& skin() const override { return skin_; }
  [[nodiscard]] SenselType sensel_type() const override { return type_; }
  [[nodiscard]] std::uint64_t frames() const override { return frames_; }
  [[nodiscard]] const Calibration& calibration() const override { return calibration_; }
  [[nodiscard]] bool has_truth() const override { return false; }
  double time(std::uint64_t index) override { return times_[index]; }
  double read(std::uint64_t index, FrameBuffer& frame) override {
    const std::span<std::byte> bytes = frame.bytes();
    std::memcpy(bytes.data(), first_ + index * bytes.size(), bytes.size());
    return times_[index];
  }
  void read_truth(std::uint64_t, ForceField&) override {}
  [[nodiscard]] const std::vector<std::string>& warnings() const override { return warnings_; }

 private:
  py::array readings_;
  SenselType type_;
  Skin skin_;
  Calibration calibration_;
  std::uint64_t frames_ = 0;
  const std::byte* first_ = nullptr;
  std::vector<double> times_;
  std::string format_ = "array";
  std::vector<std::string> warnings_;
};

/// Throws IndexError unless all frames first, first + step, ... exist.
void check_range(const FrameSource& source, std::int64_t first, std::int64_t step,
                 std::int64_t count) {
  const auto frames = static_cast<std::int64_t>(source.frames());
  const auto exists = [&](std::int64_t index) { return index >= 0 && index < frames; };
  if (count < 0 || count > frames || (count > 0 && !exists(first)) ||
      (count > 1 &&
       (step == 0 || step > frames || step < -frames || !exists(first + (count - 1) * step)))) {
    throw py::index_error("frame index out of range");
  }
}

/// Readings of `count` frames: [count, rows, cols].
py::array read_frames(FrameSource& source, std::int64_t first, std::int64_t step,
                      std::int64_t count) {
  check_range(source, first, step, count);
  const Skin& skin = source.skin();
  py::array readings(dtype_of(source.sensel_type()), Shape{count, skin.rows, skin.cols});
  auto* out = static_cast<std::byte*>(readings.mutable_data());
  const py::gil_scoped_release unlocked;
  SignalCheck check_signals;
  FrameBuffer frame(source.sensel_type(), skin.rows, skin.cols);
  for (std::int64_t i = 0; i < count; ++i) {
    check_signals();
    source.read(static_cast<std::uint64_t>(first + i * step), frame);
    out = std::ranges::copy(frame.bytes(), out).out;
  }
  return readings;
}

py::dict read_truth(FrameSource& source, std::int64_t first, std::int64_t step,
                    std::int64_t count) {
  check_range(source, first, step, count);
  if (!source.has_truth()) {
    throw Error(source.format(), "it has no true forces", "simulate one that has");
  }
  ForceStack stack(source.skin().pillar_rows(), source.skin().pillar_cols());
  {
    const py::gil_scoped_release unlocked;
    SignalCheck check_signals;
    ForceField truth(source.skin().pillar_rows(), source.skin().pillar_cols());
    stack.reserve(static_cast<std::size_t>(count));
    for (std::int64_t i = 0; i < count; ++i) {
      check_signals();
      source.read_truth(static_cast<std::uint64_t>(first + i * step), truth);
      stack.append(truth.view());
    }
  }
  return stack.release();
}

py::array_t<double> times_of(FrameSource& source, std::uint64_t most) {
  std::vector<double> times;
  {
    const py::gil_scoped_release unlocked;
    for (std::uint64_t i = 0; i < std::min(most, source.frames()); ++i)
      times.push_back(source.time(i));
  }
  const auto size = static_cast<py::ssize_t>(times.size());
  return array_of(std::move(times), {size});
}

}  // namespace

SkinCalibration calibration_of(const FrameSource& source) {
  SkinCalibration calibration;
  calibration.rows = source.skin().rows;
  calibration.cols = source.skin().cols;
  calibration.planes = source.calibration();
  return calibration;
}

void bind_frames(py::module_& module) {
  py::class_<FrameSource>(module, "FrameSource", kSource)
      .def_static(
          "open",
          [](const std::filesystem::path& path, bool trust) {
            const py::gil_scoped_release unlocked;
            return open_frames(path, {.trust = trust});
          },
          py::arg("path"), py::kw_only(), py::arg("trust") = false, kOpen)
      .def_static(
          "of_array",
          [](const py::array& readings, const py::array_t<double, py::array::forcecast>& times,
             const Skin& skin,
             const std::optional<SkinCalibration>& calibration) -> std::unique_ptr<FrameSource> {
            return std::make_unique<ArraySource>(readings, times, skin, calibration);
          },
          py::arg("readings"), py::arg("times"), py::arg("skin"), py::arg("calibration"), kArray)
      .def_property_readonly("skin", &FrameSource::skin, "its Skin")
      .def_property_readonly("calibration", &calibration_of, "its Calibration")
      .def_property_readonly("format", &FrameSource::format, "of the file")
      .def_property_readonly("has_truth", &FrameSource::has_truth, "true forces are known")
      .def_property_readonly("warnings", &FrameSource::warnings, "one sentence each")
      .def_property_readonly(
          "sensel_type", [](const FrameSource& self) { return name_of(self.sensel_type()); },
          "'uint8', 'uint16' or 'float32'")
      .def("times", &times_of, py::arg("most") = std::numeric_limits<std::uint64_t>::max(),
           "Times of all frames, or of the first `most`, float64 [frames], s.")
      .def("read", &read_frames, py::arg("first"), py::arg("step"), py::arg("count"),
           "Readings of `count` frames, [count, rows, cols].")
      .def("read_truth", &read_truth, py::arg("first"), py::arg("step"), py::arg("count"),
           "Planes of the true forces of `count` frames.")
      .def("__len__", &FrameSource::frames);
}

}  // namespace pillarfield::python
