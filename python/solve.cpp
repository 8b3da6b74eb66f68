#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "pillarfield/error.h"
#include "pillarfield/pipeline.h"
#include "pillarfield/processor.h"
#include "pillarfield/reading_check.h"
#include "pillarfield/solve_range.h"
#include "python/bindings.h"
#include "python/force_planes.h"
#include "python/frames.h"
#include "python/process.h"
#include "python/signals.h"

namespace pillarfield::python {
namespace {

constexpr int kSlots = 3;

/// Frames of a Python iterator of (readings, time), which it converted to the plan's type.
class IteratorStream final : public FrameStream {
 public:
  IteratorStream(py::iterator frames, const SolverPlan& plan, bool falling)
      : frames_(std::move(frames)), plan_(plan), mirrors_(falling) {}

  [[nodiscard]] const Skin& skin() const override { return plan_.skin; }
  [[nodiscard]] SenselType sensel_type() const override { return plan_.sensel_type; }

  [[nodiscard]] Arrival next(StreamedFrame& frame, std::chrono::nanoseconds) override {
    const py::gil_scoped_acquire locked;
    const auto item = py::reinterpret_steal<py::object>(PyIter_Next(frames_.ptr()));
    if (!item) {
      if (PyErr_Occurred() != nullptr) throw py::error_already_set();
      return Arrival::ended;
    }
    const auto [readings, time_s, missing] =
        item.cast<std::tuple<py::array, double, std::vector<std::array<std::uint32_t, 4>>>>();
    const FrameView view = frame_of(readings);
    check(view, plan_.skin, plan_.sensel_type, "frames");
    const std::span<std::byte> bytes = frame.buffer.bytes();
    std::memcpy(bytes.data(), view.data, bytes.size());
    if (mirrors_) mirror(frame.buffer);
    frame.readings = frame.buffer.view();
    frame.time_s = time_s;
    frame.sequence = next_++;
    frame.missing.clear();
    for (const auto& [first_row, rows, first_col, cols] : missing) {
      frame.missing.push_back({first_row, rows, first_col, cols});
    }
    return Arrival::arrived;
  }

 private:
  py::iterator frames_;
  const SolverPlan& plan_;
  bool mirrors_;
  std::uint64_t next_ = 0;
};

/// Collects planes, times and contacts.
class Collector final : public ForceSink {
 public:
  explicit Collector(const SolverPlan& plan, bool judges_errors = false)
      : planes_(plan.skin), check_(plan, judges_errors) {}

  void reserve(std::size_t frames) {
    planes_.reserve(frames);
    times_.reserve(frames);
  }
  void append(const SolvedFrame& frame) override {
    planes_.append(frame.forces);
    check_.append(frame);
    times_.push_back(frame.time_s);
    if (frame.contacts != nullptr) {
      contacts_.push_back(std::make_shared<FrameContacts>(*frame.contacts));
    }
  }
  [[nodiscard]] py::dict release(bool with_contacts) {
    py::dict result = planes_.release();
    const auto size = static_cast<py::ssize_t>(times_.size());
    result["warnings"] = py::cast(check_.warnings());
    result["times"] = array_of(std::move(times_), {size});
    if (with_contacts) result["contacts"] = py::cast(std::move(contacts_));
    return result;
  }

 private:
  ForceStack planes_;
  ReadingCheck check_;
  std::vector<double> times_;
  std::vector<std::shared_ptr<FrameContacts>> contacts_;
};

/// Solves all frames; called without Python's lock.
void run(FrameStream& stream, const SolverPlan& plan, bool contacts, const Device& device,
         Collector& collector) {
  Processor processor(device, plan, {.frames_in_flight = kSlots});
  std::optional<ContactTracker> tracker;
  if (contacts) {
    ContactOptions options;
    set_sensor(options, plan);
    tracker.emplace(plan.skin.element_pitch_mm(), options);
  }
  SignalCheck check_signals;
  Pipeline pipeline(stream, processor, {&collector},
                    {.frames_in_flight = kSlots,
                     .contacts = tracker ? &*tracker : nullptr,
                     .stop = [&] { return check_signals(), false; }});
  pipeline.run();
}

py::dict solve_source(Frames& frames, const SolverPlan& plan, bool contacts,
                      const std::string& device) {
  Collector collector(plan);
  {
    const py::gil_scoped_release unlocked;
    const std::lock_guard alone(frames.alone);
    collector.reserve(frames.source->frames());
    const auto stream = file_stream(*frames.source);
    run(*stream, plan, contacts, device_named(device), collector);
  }
  return collector.release(contacts);
}

py::dict solve_iterator(const py::iterator& frames, const SolverPlan& plan, bool contacts,
                        const std::string& device, bool falling) {
  Collector collector(plan, true);
  IteratorStream stream(frames, plan, falling);
  {
    const py::gil_scoped_release unlocked;
    run(stream, plan, contacts, device_named(device), collector);
  }
  return collector.release(contacts);
}

/// Solves the frames first to end - 1 into an HDF5 file.
void solve_to_file(Frames& frames, const SolverPlan& plan, const std::string& source_name,
                   const std::filesystem::path& output, std::uint64_t first, std::uint64_t end,
                   std::optional<std::uint64_t> warm_up, bool contacts,
                   const std::string& device_name, bool overwrite) {
  const py::gil_scoped_release unlocked;
  const std::lock_guard alone(frames.alone);
  RangeOptions options;
  options.warm_up = warm_up;
  if (contacts) set_sensor(options.contacts.emplace(), plan);
  SignalCheck check_signals;
  options.stop = [&] { return check_signals(), false; };
  const Device device = device_named(device_name).for_plan(plan);
  ForceFileInfo info = file_info(plan, device.info().name, source_name);
  info.contacts = options.contacts;
  info.first_frame = first;
  info.frames = end - std::min(first, end);
  const auto sink =
      create_force_sink(output, info, overwrite ? Replace::anything : Replace::results);
  static_cast<void>(solve_range(*frames.source, device, plan, {first, end}, options, {sink.get()}));
  sink->finish();
}

std::vector<std::string> allow_for_frames(SolverPlan& plan, Frames& frames) {
  const py::gil_scoped_release unlocked;
  const std::lock_guard alone(frames.alone);
  return allow_for_errors(plan, *frames.source);
}

}  // namespace

void bind_solve(py::module_& module) {
  constexpr const char* kText =
      "Solves all frames: planes of forces, 'times' and, if wanted, 'contacts' of each frame; and "
      "'warnings' about their readings.";
  module.def(
      "allow_for_errors", &allow_for_frames, py::arg("plan"), py::arg("source"),
      "Raises the noise and the relative error that the plan states to what the frames show; "
      "returns a sentence about each.");
  module.def("solve_source", &solve_source, py::arg("source"), py::arg("plan"), py::arg("contacts"),
             py::arg("device"), kText);
  module.def("solve_iterator", &solve_iterator, py::arg("frames"), py::arg("plan"),
             py::arg("contacts"), py::arg("device"), py::arg("falling") = false, kText);
  module.def("solve_to_file", &solve_to_file, py::arg("source"), py::arg("plan"),
             py::arg("source_name"), py::arg("output"), py::arg("first"), py::arg("end"),
             py::arg("warm_up"), py::arg("contacts"), py::arg("device"), py::arg("overwrite"),
             "Solves a range of frames into an HDF5 file.");
}

}  // namespace pillarfield::python
