#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pillarfield/error.h"
#include "pillarfield/live_session.h"
#include "python/bindings.h"
#include "python/force_planes.h"
#include "python/process.h"
#include "python/signals.h"

namespace pillarfield::python {
namespace {

constexpr const char* kLiveSource = "Frames of a sensor as they come.";
constexpr const char* kLiveSink = "Passes forces on without ever waiting for who receives them.";

/// A live source, used by one thread at a time.
class LiveFrames {
 public:
  LiveFrames(const std::string& source, const Skin& skin, std::uint32_t serial_baud) {
    const py::gil_scoped_release unlocked;
    LiveSourceOptions options;
    options.skin = skin;
    options.serial_baud = serial_baud;
    SignalCheck check_signals;
    options.stop = [&] { return check_signals(), false; };
    stream_.emplace(open_live_source(source, options));
    skin_ = stream_->get()->skin();
    sensel_type_ = stream_->get()->sensel_type();
    frame_ = std::make_unique<StreamedFrame>(sensel_type_, skin_);
  }

  /// The next frame as (readings, time, sequence, missing); None where none came in time. Throws
  /// StopIteration at the end.
  py::object next(double timeout_s) {
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::nanoseconds kPatience = std::chrono::milliseconds(100);
    constexpr double kMostSeconds = 1e9;
    const double seconds =
        std::isnan(timeout_s) ? kMostSeconds : std::clamp(timeout_s, 0.0, kMostSeconds);
    const auto end =
        Clock::now() + std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * seconds));
    for (;;) {
      const std::chrono::nanoseconds left = end - Clock::now();
      py::object frame = next_within(std::clamp(left, std::chrono::nanoseconds(0), kPatience));
      if (!frame.is_none() || left <= std::chrono::nanoseconds(0)) return frame;
      // Signal handlers and other threads may use, or close, the source meanwhile.
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
  }

  [[nodiscard]] py::dict health() {
    StreamHealth health;
    with_stream([&](FrameStream& stream) { health = stream.health(); });
    py::dict counts;
    counts["frames"] = health.frames;
    counts["lost"] = health.lost;
    counts["incomplete"] = health.incomplete;
    counts["late"] = health.late;
    counts["duplicates"] = health.duplicates;
    counts["reordered"] = health.reordered;
    counts["invalid"] = health.invalid;
    counts["restarts"] = health.restarts;
    counts["clock_jumps"] = health.clock_jumps;
    counts["overrun"] = health.overrun;
    counts["rate_hz"] = health.rate_hz;
    counts["mismatch"] = health.mismatch;
    return counts;
  }

  void discard_waiting() {
    with_stream([](FrameStream& stream) { stream.discard_waiting(); });
  }

  void close() {
    const py::gil_scoped_release unlocked;
    if (stream_->is_foreign()) return;
    const std::lock_guard alone(mutex_);
    stream_->reset();
  }

  [[nodiscard]] const Skin& skin() const { return skin_; }
  [[nodiscard]] SenselType sensel_type() const { return sensel_type_; }

 private:
  template <class Call>
  void with_stream(Call call) {
    if (stream_->is_foreign()) throw_foreign("the live source");
    const py::gil_scoped_release unlocked;
    const std::lock_guard alone(mutex_);
    FrameStream* const stream = stream_->get();
    if (stream == nullptr) throw Error("the live source", "it is closed", "open it again");
    call(*stream);
  }

  py::object next_within(std::chrono::nanoseconds patience) {
    py::array readings(dtype_of(sensel_type_), Shape{skin_.rows, skin_.cols});
    auto* const copy = static_cast<std::byte*>(readings.mutable_data());
    Arrival arrival = Arrival::timed_out;
    std::vector<std::array<std::uint32_t, 4>> missing;
    double time_s = 0;
    std::uint64_t sequence = 0;
    with_stream([&](FrameStream& stream) {
      arrival = stream.next(*frame_, patience);
      if (arrival != Arrival::arrived) return;
      pillarfield::copy_readings(frame_->readings, copy);
      time_s = frame_->time_s;
      sequence = frame_->sequence;
      for (const auto& [first_row, rows, first_col, cols] : frame_->missing) {
        missing.push_back({first_row, rows, first_col, cols});
      }
    });
    if (arrival == Arrival::ended) throw py::stop_iteration();
    if (arrival == Arrival::timed_out) return py::none();
    return py::make_tuple(readings, time_s, sequence, missing);
  }

  std::mutex mutex_;
  std::optional<ProcessBound<FrameStream>> stream_;
  Skin skin_;
  SenselType sensel_type_ = SenselType::u8;
  std::unique_ptr<StreamedFrame> frame_;
};

/// A live sink, used by one thread at a time.
class Sink {
 public:
  Sink(const std::string& target, const SolverPlan& plan, bool contacts, const std::string& source,
       bool overwrite, std::vector<std::string> allow_origins)
      : target_(target), plan_(plan) {
    const py::gil_scoped_release unlocked;
    LiveSinkInfo info =
        live_sink_info(plan, "", source, contacts ? std::optional(ContactOptions{}) : std::nullopt);
    info.replace = overwrite ? Replace::anything : Replace::results;
    info.allowed_origins = std::move(allow_origins);
    sink_.emplace(create_live_sink(target, info));
  }

  void send(const py::dict& planes, const std::shared_ptr<FrameContacts>& contacts, double time_s,
            std::uint64_t sequence) {
    const ForceArrays forces(planes);
    if (forces.frames() != 1 || forces.layout() != plan_.skin.layout ||
        forces.rows() != plan_.skin.element_rows() || forces.cols() != plan_.skin.element_cols() ||
        planes.contains("theta") < plan_.angles ||
        planes.contains("uncertainty_normal") < plan_.uncertainty) {
      throw Error(target_, "the forces do not fit its plan",
                  "send one frame of the plan's size and outputs");
    }
    with_sink([&](LiveSink& sink) {
      sink.append({.forces = forces.frame(0),
                   .contacts = contacts.get(),
                   .time_s = time_s,
                   .sequence = sequence,
                   .arrived = std::chrono::steady_clock::now().time_since_epoch()});
    });
  }

  [[nodiscard]] py::dict statistics() {
    LiveSinkStatistics done;
    with_sink([&](LiveSink& sink) { done = sink.statistics(); });
    py::dict counts;
    counts["frames"] = done.frames;
    counts["dropped"] = done.dropped;
    counts["clients"] = done.clients;
    counts["refused"] = done.refused;
    counts["failure"] = done.failure;
    counts["notice"] = done.notice;
    return counts;
  }

  void close(bool finish) {
    const py::gil_scoped_release unlocked;
    if (sink_->is_foreign()) return;
    const std::lock_guard alone(mutex_);
    if (finish && sink_->get() != nullptr) sink_->get()->finish();
    sink_->reset();
  }

 private:
  template <class Call>
  void with_sink(Call call) {
    if (sink_->is_foreign()) throw_foreign(target_);
    const py::gil_scoped_release unlocked;
    const std::lock_guard alone(mutex_);
    LiveSink* const sink = sink_->get();
    if (sink == nullptr) throw Error(target_, "it is closed", "open it again");
    call(*sink);
  }

  std::mutex mutex_;
  std::string target_;
  SolverPlan plan_;
  std::optional<ProcessBound<LiveSink>> sink_;
};

}  // namespace

void bind_live(py::module_& module) {
  py::class_<LiveFrames>(module, "LiveFrames", kLiveSource)
      .def(py::init<const std::string&, const Skin&, std::uint32_t>(), py::arg("source"),
           py::arg("skin"), py::arg("serial_baud"))
      .def("next", &LiveFrames::next, py::arg("timeout_s"))
      .def_property_readonly("health", &LiveFrames::health,
                             "What came and what did not: frames, lost, incomplete, late, ..., "
                             "rate_hz; as mismatch, the size of frames that came instead, or ''.")
      .def("discard_waiting", &LiveFrames::discard_waiting,
           "Discards the frames that wait, without counting them as lost.")
      .def("close", &LiveFrames::close, "Closes the source.")
      .def_property_readonly("skin", &LiveFrames::skin,
                             "Skin with the rows and columns of the frames, for a Plan")
      .def_property_readonly(
          "sensel_type", [](const LiveFrames& self) { return name_of(self.sensel_type()); },
          "'uint8', 'uint16' or 'float32', for a Plan");
  py::class_<Sink>(module, "LiveSink", kLiveSink)
      .def(py::init<const std::string&, const SolverPlan&, bool, const std::string&, bool,
                    std::vector<std::string>>(),
           py::arg("target"), py::arg("plan"), py::arg("contacts"), py::arg("source"),
           py::arg("overwrite"), py::arg("allow_origins"))
      .def("send_planes", &Sink::send, py::arg("planes"), py::arg("contacts"), py::arg("time_s"),
           py::arg("sequence"))
      .def_property_readonly("statistics", &Sink::statistics,
                             "frames, dropped, clients, refused; the failure that stopped it, or "
                             "''; and as notice the first client refused for its origin, or ''.")
      .def("close", &Sink::close, py::arg("finish") = true,
           "Closes the sink. finish: complete its file; else it stays a part.");
}

}  // namespace pillarfield::python
