#include "python/frames.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <mutex>
#include <numeric>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "io/plain/stated_words.h"
#include "pillarfield/array_axes.h"
#include "pillarfield/error.h"
#include "python/bindings.h"
#include "python/force_planes.h"
#include "python/pitch.h"
#include "python/signals.h"

namespace pillarfield::python {
namespace {

constexpr const char* kSource =
    R"(Frames with random access: readings, times, skin and calibration.)";
constexpr const char* kArray = R"(Frames of an array, without a copy.

readings: uint8, uint16 or float32 [frames, rows, cols], dense
times: float64 [frames], s
skin: Skin with constants; its rows and columns are replaced by those of the array
calibration: Calibration, or None
axes_are_known: else raises Error if the frames seem to lie along another axis
falling: readings fall under load; they are mirrored as they are read
unit: of the readings; sets the skin's counts_per_newton, with pitch_mm and layout, or the skin's)";

using TimeArray = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Frames of an array, whose values must not change meanwhile.
class ArraySource final : public FrameSource {
 public:
  ArraySource(py::array readings, const TimeArray& times, const Skin& skin,
              const std::optional<SkinCalibration>& calibration, bool falling)
      : readings_(std::move(readings)),
        type_(sensel_type_of(readings_)),
        skin_(skin),
        mirrors_(falling) {
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
    skin_.falling |= falling;
    check(skin_, "frames");
    if (calibration) {
      require_fitting(*calibration, skin_, "frames");
      apply(*calibration, skin_, calibration_);
    }
    warnings_ = layout_warnings(skin_);
    if (!skin_.has_pillars()) return;
    std::ranges::move(size_warnings(skin_.rows, skin_.cols), std::back_inserter(warnings_));
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
    if (readings_.data() != first_ ||
        static_cast<std::uint64_t>(readings_.nbytes()) < frames_ * bytes.size()) {
      throw Error("frames", "their array was resized", "give an array that keeps its size");
    }
    std::memcpy(bytes.data(), first_ + index * bytes.size(), bytes.size());
    if (mirrors_) mirror(frame);
    return times_[index];
  }
  void read_truth(std::uint64_t, ForceField&) override {}
  [[nodiscard]] const std::vector<std::string>& warnings() const override { return warnings_; }

 private:
  py::array readings_;
  SenselType type_;
  Skin skin_;
  bool mirrors_;
  Calibration calibration_;
  std::uint64_t frames_ = 0;
  const std::byte* first_ = nullptr;
  std::vector<double> times_;
  std::string format_ = "array";
  std::vector<std::string> warnings_;
};

/// Readings of `count` frames: [count, rows, cols].
py::array read_frames(Frames& frames, const IndexRange& range) {
  FrameSource& source = *frames.source;
  range.check(source.frames());
  const Skin& skin = source.skin();
  py::array readings(dtype_of(source.sensel_type()),
                     Shape{static_cast<py::ssize_t>(range.count), skin.rows, skin.cols});
  auto* out = static_cast<std::byte*>(readings.mutable_data());
  const py::gil_scoped_release unlocked;
  const std::lock_guard alone(frames.alone);
  SignalCheck check_signals;
  FrameBuffer frame(source.sensel_type(), skin.rows, skin.cols);
  for (std::size_t i = 0; i < range.count; ++i) {
    check_signals();
    source.read(range[i], frame);
    out = std::ranges::copy(frame.bytes(), out).out;
  }
  return readings;
}

py::dict read_truth(Frames& frames, const IndexRange& range) {
  FrameSource& source = *frames.source;
  range.check(source.frames());
  if (!source.has_truth()) {
    throw Error(source.format(), "it has no true forces", "simulate one that has");
  }
  ForceStack stack(source.skin());
  {
    const py::gil_scoped_release unlocked;
    const std::lock_guard alone(frames.alone);
    SignalCheck check_signals;
    ForceField truth(source.skin().element_rows(), source.skin().element_cols());
    stack.reserve(range.count);
    for (std::size_t i = 0; i < range.count; ++i) {
      check_signals();
      source.read_truth(range[i], truth);
      stack.append(truth.view());
    }
  }
  return stack.release();
}

py::array_t<double> times_of(Frames& frames) {
  std::vector<double> times;
  {
    const py::gil_scoped_release unlocked;
    const std::lock_guard alone(frames.alone);
    FrameSource& source = *frames.source;
    for (std::uint64_t i = 0; i < source.frames(); ++i) times.push_back(source.time(i));
  }
  const auto size = static_cast<py::ssize_t>(times.size());
  return array_of(std::move(times), {size});
}

SkinCalibration calibration_of(const Frames& frames) {
  SkinCalibration calibration;
  calibration.rows = frames.source->skin().rows;
  calibration.cols = frames.source->skin().cols;
  calibration.falling = frames.source->skin().falling;
  calibration.planes = frames.source->calibration();
  return calibration;
}

std::unique_ptr<Frames> open(
    const std::variant<std::filesystem::path, std::vector<std::filesystem::path>>& path, bool trust,
    std::string dataset, std::string times,
    const std::optional<std::pair<std::uint32_t, std::uint32_t>>& frame_size,
    std::optional<double> rate_hz, std::uint64_t tare_frames, const std::string& axes,
    const std::string& layout, bool falling, bool untimed, std::string columns, std::string where,
    std::string readings, const std::optional<Pitch>& pitch_mm) {
  const py::gil_scoped_release unlocked;
  ReadOptions options;
  options.trust = trust;
  options.dataset = std::move(dataset);
  options.times = std::move(times);
  if (frame_size) options.frame_size = {frame_size->first, frame_size->second};
  options.columns = std::move(columns);
  options.where = std::move(where);
  options.readings = std::move(readings);
  options.sensel_pitch_mm = pitch_mm;
  options.rate_hz = rate_hz;
  options.tare_frames = tare_frames;
  options.falling = falling;
  options.untimed = untimed;
  if (!axes.empty()) options.axes = parse_axes(axes);
  options.layout = layout_in(layout);
  return std::make_unique<Frames>(
      std::visit([&](const auto& given) { return open_frames(given, options); }, path));
}

std::unique_ptr<Frames> of_array(const py::array& readings, const TimeArray& times, Skin skin,
                                 const std::optional<SkinCalibration>& calibration,
                                 bool axes_are_known, bool falling, std::string unit,
                                 std::optional<Pitch> pitch_mm, const std::string& layout) {
  if (!unit.empty()) {
    if (!pitch_mm && skin.states_pitch()) pitch_mm = skin.sensel_pitch_mm;
    ReadOptions known;
    known.readings = std::move(unit);
    known.sensel_pitch_mm = pitch_mm;
    known.layout = layout.empty() ? skin.layout : layout_in(layout);
    known.falling = falling;
    std::vector<std::string> notes;
    const auto newtons = StatedWords().newtons_per_cell(std::nullopt, known, notes, "frames");
    if (newtons) skin.counts_per_newton = *known.counts_per_newton / *newtons;
    skin.stated.counts_per_newton |= newtons.has_value();
  }
  auto source = std::make_unique<ArraySource>(readings, times, skin, calibration, falling);
  if (!axes_are_known) require_likely_axes(*source, "frames");
  return std::make_unique<Frames>(std::move(source));
}

/// Positions of the axes frames, rows and columns in an array whose axes `words` names in order.
std::vector<std::size_t> axis_positions(const std::string& words) {
  const std::vector<ArrayAxis> axes = parse_axes(words);
  std::vector<std::size_t> positions(axes.size());
  std::iota(positions.begin(), positions.end(), 0);
  std::ranges::sort(positions, {}, [&](std::size_t position) { return axes[position]; });
  return positions;
}

/// Throws Error for readings, dense, with axes of components or pads.
void require_axes(const py::array& readings) {
  std::vector<std::uint64_t> shape;
  for (py::ssize_t axis = 0; axis < readings.ndim(); ++axis) {
    shape.push_back(static_cast<std::uint64_t>(readings.shape(axis)));
  }
  const auto read = [&](std::uint64_t index) {
    const py::array slice = readings.attr("__getitem__")(index);
    const TimeArray numbers(slice.attr("ravel")());
    return std::vector<double>(numbers.data(), numbers.data() + numbers.size());
  };
  const auto take = [&](const std::string& index) {
    return fmt::format("give frames{}{}", index,
                       shape.size() == 3 && shape[0] != 3 ? ".reshape(-1, ROWS, COLS)" : "");
  };
  require_frame_axes(shape, read, "frames", take);
}

void write(Frames& frames, const std::filesystem::path& path, bool overwrite) {
  const py::gil_scoped_release unlocked;
  const std::lock_guard alone(frames.alone);
  FrameSource& source = *frames.source;
  const Skin& skin = source.skin();
  RecordingWriter writer(path, skin, source.sensel_type(), source.calibration(),
                         {.replace = overwrite ? Replace::anything : Replace::results});
  FrameBuffer frame(source.sensel_type(), skin.rows, skin.cols);
  SignalCheck check_signals;
  for (std::uint64_t i = 0; i < source.frames(); ++i) {
    check_signals();
    const double time_s = source.read(i, frame);
    writer.append(frame.view(), time_s);
  }
  writer.finish();
}

}  // namespace

void bind_frames(py::module_& module) {
  py::class_<Frames>(module, "FrameSource", kSource)
      .def(py::init(&open), py::arg("path"), py::kw_only(), py::arg("trust") = false,
           py::arg("dataset") = "", py::arg("times") = "", py::arg("frame_size") = py::none(),
           py::arg("rate_hz") = py::none(), py::arg("tare_frames") = 0, py::arg("axes") = "",
           py::arg("layout") = "", py::arg("falling") = false, py::arg("untimed") = false,
           py::arg("columns") = "", py::arg("where") = "", py::arg("readings") = "",
           py::arg("pitch_mm") = py::none())
      .def_static("of_array", &of_array, py::arg("readings"), py::arg("times"), py::arg("skin"),
                  py::arg("calibration"), py::arg("axes_are_known") = false,
                  py::arg("falling") = false, py::arg("unit") = "",
                  py::arg("pitch_mm") = py::none(), py::arg("layout") = "", kArray)
      .def("write", &write, py::arg("path"), py::kw_only(), py::arg("overwrite"),
           "Writes all frames as a recording.")
      .def_property_readonly(
          "skin", [](const Frames& self) { return self.source->skin(); },
          "Skin with the constants of the file")
      .def_property_readonly("calibration", &calibration_of,
                             "Calibration with the planes of the file")
      .def_property_readonly(
          "format", [](const Frames& self) { return self.source->format(); }, "of the file")
      .def_property_readonly(
          "has_truth", [](const Frames& self) { return self.source->has_truth(); },
          "whether it is simulated and has its true forces")
      .def_property_readonly(
          "warnings", [](const Frames& self) { return self.source->warnings(); },
          "warnings about the file, one sentence each")
      .def_property_readonly(
          "sensel_type", [](const Frames& self) { return name_of(self.source->sensel_type()); },
          "'uint8', 'uint16' or 'float32'")
      .def_property_readonly("times", &times_of, "times of all frames, float64 [frames], s")
      .def(
          "read",
          [](Frames& self, std::int64_t first, std::int64_t step, std::int64_t count) {
            return read_frames(self, IndexRange(first, step, count));
          },
          py::arg("first"), py::arg("step"), py::arg("count"),
          "Readings of `count` frames, [count, rows, cols].")
      .def(
          "read_truth",
          [](Frames& self, std::int64_t first, std::int64_t step, std::int64_t count) {
            return read_truth(self, IndexRange(first, step, count));
          },
          py::arg("first"), py::arg("step"), py::arg("count"),
          "Planes of the true forces of `count` frames.")
      .def("__len__", [](const Frames& self) { return self.source->frames(); });
  module.def("axis_positions", &axis_positions, py::arg("words"),
             "Positions of the axes frames, rows and columns in an array with axes of this order.");
  module.def("require_frame_axes", &require_axes, py::arg("readings"),
             "Raises Error for readings with axes of components or pads.");
  module.def("size_warnings", &size_warnings, py::arg("rows"), py::arg("cols"),
             "Sentences about an odd last row or column, which has no pillars.");
  module.def("require_likely_frame", &require_likely_frame, py::arg("rows"), py::arg("cols"),
             py::arg("place"), "Raises Error if an array is too elongated for one frame.");
}

}  // namespace pillarfield::python
