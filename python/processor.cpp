#include "pillarfield/processor.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <array>
#include <cstring>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pillarfield/contact_tracker.h"
#include "pillarfield/error.h"
#include "pillarfield/skin_calibration.h"
#include "pipeline/missing_pillars.h"
#include "python/bindings.h"
#include "python/force_planes.h"
#include "python/process.h"

namespace pillarfield::python {
namespace {

constexpr const char* kProcessor =
    "Solves frames one by one, several in flight, and lends their results without a copy.";

/// first_row, rows, first_col, cols of sensels.
using Block = std::array<std::uint32_t, 4>;

/// A received frame in pinned memory of the device, or in a copy.
struct Received {
  ForceFieldView forces;
  std::unique_ptr<ProcessBound<Processor::PinnedResult>> pinned;
  std::unique_ptr<ForceCopy> copied;
  std::shared_ptr<FrameContacts> contacts;
  double time_s = 0;

  /// Arrays over the memory, which they own from now on.
  [[nodiscard]] py::dict release() {
    py::dict result = pinned ? lent_planes(forces, capsule_of(std::move(pinned)))
                             : lent_planes(forces, capsule_of(std::move(copied)));
    result["times"] = time_s;
    if (contacts) result["contacts"] = std::move(contacts);
    return result;
  }
};

/// A Processor with buffers for the frames in flight and slots for `lent` results. Threads take
/// turns.
class Ring {
 public:
  Ring(const SolverPlan& plan, int frames_in_flight, int lent, bool contacts,
       const std::string& device)
      : plan_(plan), lent_(lent) {
    if (frames_in_flight < 1 || lent < 0 || frames_in_flight > 64 || lent > 63 ||
        frames_in_flight + lent > 64) {
      throw Error("Processor", "frames_in_flight or lent is out of range",
                  "give at least 1 and 0, together at most 64");
    }
    const py::gil_scoped_release unlocked;
    processor_.emplace(std::make_unique<Processor>(
        device_named(device), plan,
        Processor::Options{.frames_in_flight = frames_in_flight + lent}));
    for (int i = 0; i < frames_in_flight; ++i) {
      frames().vacant.push_back(processor_->get()->frame_buffer());
    }
    if (!contacts) return;
    ContactOptions options;
    set_sensor(options, plan);
    tracker_.emplace(std::make_unique<ContactTracker>(plan.skin.element_pitch_mm(), options));
  }

  void submit(const py::array& readings, double time_s, const std::vector<Block>& missing) {
    const FrameView frame = frame_of(readings);
    check(frame, plan_.skin, plan_.sensel_type, "Processor.submit");
    with_processor([&](Processor& processor) {
      std::deque<FrameBuffer>& vacant = frames().vacant;
      if (vacant.empty()) {
        throw Error("Processor.submit", "all frames are in flight",
                    "receive() one first, or give more frames_in_flight");
      }
      FrameBuffer& buffer = vacant.front();
      std::memcpy(buffer.bytes().data(), frame.data, buffer.bytes().size());
      std::vector<SenselBlock> blocks = blocks_of(missing);
      processor.submit(buffer.view());
      frames().flying.push_back({std::move(buffer), time_s, std::move(blocks)});
      vacant.pop_front();
    });
  }

  py::dict receive() {
    Received received;
    with_processor(
        [&](Processor& processor) { received = deliver(processor, processor.receive()); });
    return received.release();
  }

  std::optional<py::dict> try_receive() {
    std::optional<Received> received;
    with_processor([&](Processor& processor) {
      if (const auto forces = processor.try_receive()) received = deliver(processor, *forces);
    });
    if (!received) return std::nullopt;
    return received->release();
  }

  void set_tare(const py::object& tare) {
    const py::object given = py::getattr(tare, "calibration", tare);  // of a step
    SolverPlan plan = plan_;
    if (py::isinstance<SkinCalibration>(given)) {
      apply(given.cast<SkinCalibration>(), plan.skin, plan.calibration);
    } else {
      plan.calibration.tare = plane_from<float>(given, plan.skin.rows, plan.skin.cols, "set_tare");
    }
    with_processor([&](Processor& processor) {
      processor.set_plan(plan);
      if (tracker_) tracker_->get()->set_sensor(plan);
    });
    plan_ = std::move(plan);
  }

  py::object tare() {
    std::vector<float> values;
    with_processor([&](Processor& processor) { values = processor.tare(); });
    return plane_or_none(values, plan_.skin.rows, plan_.skin.cols);
  }

  [[nodiscard]] std::size_t in_flight() {
    std::size_t count = 0;
    with_processor([&](Processor&) { count = frames().flying.size(); });
    return count;
  }

  void close() {
    const py::gil_scoped_release unlocked;
    if (processor_->is_foreign()) return;
    const std::lock_guard alone(mutex_);
    processor_->reset();
    frames_.reset();
  }

  [[nodiscard]] SolverPlan plan() const { return plan_; }  // A copy: set_tare() changes it.

 private:
  struct Flying {
    FrameBuffer buffer;
    double time_s;
    std::vector<SenselBlock> missing;
  };
  struct Frames {
    std::deque<FrameBuffer> vacant;
    std::deque<Flying> flying;
  };

  [[nodiscard]] Frames& frames() { return *frames_.get(); }

  template <class Call>
  void with_processor(Call call) {
    const py::gil_scoped_release unlocked;
    if (processor_->is_foreign()) throw_foreign("Processor");
    const std::lock_guard alone(mutex_);
    Processor* const processor = processor_->get();
    if (processor == nullptr) throw Error("Processor", "it is closed", "make another one");
    call(*processor);
  }

  static std::vector<SenselBlock> blocks_of(const std::vector<Block>& missing) {
    std::vector<SenselBlock> blocks;
    for (const auto& [first_row, rows, first_col, cols] : missing) {
      blocks.push_back({first_row, rows, first_col, cols});
    }
    return blocks;
  }

  Received deliver(Processor& processor, ForceFieldView forces) {
    Flying flown = std::move(frames().flying.front());
    frames().flying.pop_front();
    frames().vacant.push_back(std::move(flown.buffer));
    const bool is_whole = flown.missing.empty();
    if (!is_whole) forces = missing_.without(forces, flown.missing);
    Received received;
    received.time_s = flown.time_s;
    if (tracker_) {
      received.contacts = std::make_shared<FrameContacts>(tracker_->get()->update(
          forces, flown.time_s, is_whole ? processor.contacts() : FoundContacts{}));
    }
    if (is_whole && processor.pinned() < lent_) {
      received.pinned = std::make_unique<ProcessBound<Processor::PinnedResult>>(
          std::make_unique<Processor::PinnedResult>(processor.pin()));
    } else {
      received.copied = std::make_unique<ForceCopy>(forces);
      forces = received.copied->view();
    }
    received.forces = forces;
    return received;
  }

  std::mutex mutex_;
  SolverPlan plan_;
  int lent_;
  ProcessBound<Frames> frames_{std::make_unique<Frames>()};
  /// Ends before the frames that it reads.
  std::optional<ProcessBound<Processor>> processor_;
  std::optional<ProcessBound<ContactTracker>> tracker_;
  MissingPillars missing_;
};

std::string device_text(const DeviceInfo& device) {
  return fmt::format("<Device {}: {}, {} lanes{}>",
                     device.index < 0 ? "'host'" : std::to_string(device.index), device.name,
                     device.lanes,
                     device.unsuitable.empty() ? "" : "; unsuitable: " + device.unsuitable);
}

std::vector<DeviceInfo> devices() {
  const py::gil_scoped_release unlocked;
  std::vector<DeviceInfo> all = list_devices();
  all.insert(all.begin(), open_device("host").info());
  return all;
}

}  // namespace

void bind_processor(py::module_& module) {
  py::class_<DeviceInfo>(module, "Device", "A device that solves; devices() lists them.")
      .def_readonly("name", &DeviceInfo::name, "of the processor or graphics card")
      .def_readonly("platform", &DeviceInfo::platform, "its driver; empty for the host")
      .def_readonly("type", &DeviceInfo::type, "'CPU', 'GPU', 'accelerator', 'other' or 'host'")
      .def_readonly("lanes", &DeviceInfo::lanes, "pillars that it solves in one instruction")
      .def_readonly("unsuitable", &DeviceInfo::unsuitable, "why it is passed over; empty: it fits")
      .def_property_readonly(
          "index",
          [](const DeviceInfo& self) {
            return self.index < 0 ? std::nullopt : std::optional<int>(self.index);
          },
          "for device=; None: the host without OpenCL, device='host'")
      .def("__repr__", &device_text);
  module.def("devices", &devices,
             "The devices that solve: the host, and those of OpenCL. device= of solve() takes an "
             "index or a part of a name.");
  py::class_<Ring>(module, "Processor", kProcessor)
      .def(py::init<const SolverPlan&, int, int, bool, const std::string&>(), py::arg("plan"),
           py::arg("frames_in_flight"), py::arg("lent"), py::arg("contacts"), py::arg("device"))
      .def("submit_readings", &Ring::submit, py::arg("readings"), py::arg("time_s"),
           py::arg("missing"))
      .def("receive_planes", &Ring::receive)
      .def("try_receive_planes", &Ring::try_receive)
      .def("set_tare", &Ring::set_tare, py::arg("tare"))
      .def_property_readonly("tare", &Ring::tare,
                             "The tare after all frames so far, float32 [R, C], counts, or None.")
      .def("close", &Ring::close, "Frees the device, but no result that is held.")
      .def_property_readonly("plan", &Ring::plan, "its Plan")
      .def_property_readonly("in_flight", &Ring::in_flight,
                             "Frames submitted and not yet received.");
}

}  // namespace pillarfield::python
