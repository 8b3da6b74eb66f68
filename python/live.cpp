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
#include "pillarfield/result_stream.h"
#include "python/bindings.h"
#include "python/force_planes.h"
#include "python/frames.h"
#include "python/pitch.h"
#include "python/process.h"
#include "python/signals.h"

namespace pillarfield::python {
namespace {

constexpr const char* kLiveSource = "Frames of a sensor as they come.";
constexpr const char* kLiveResults = "Results that another program writes, as they come.";
constexpr const char* kLiveSink = "Passes forces on without ever waiting for who receives them.";

/// Seconds to wait; NaN is as long as can be.
std::chrono::nanoseconds nanoseconds_of(double timeout_s) {
  constexpr double kMostSeconds = 1e9;
  const double seconds =
      std::isnan(timeout_s) ? kMostSeconds : std::clamp(timeout_s, 0.0, kMostSeconds);
  return std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * seconds));
}

/// Waits for next_within(patience) to give something, at most for `timeout_s`; None if nothing
/// came.
template <class Next>
py::object wait_for_next(double timeout_s, Next next_within) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::nanoseconds kPatience = std::chrono::milliseconds(100);
  const auto end = Clock::now() + nanoseconds_of(timeout_s);
  for (;;) {
    const std::chrono::nanoseconds left = end - Clock::now();
    py::object next = next_within(std::clamp(left, std::chrono::nanoseconds(0), kPatience));
    if (!next.is_none() || left <= std::chrono::nanoseconds(0)) return next;
    // Signal handlers and other threads may use, or close, the source meanwhile.
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
}

py::dict counts_of(const StreamHealth& health) {
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

/// A stream that several threads use in turn, until it is closed.
template <class Stream>
class SharedStream {
 public:
  explicit SharedStream(std::unique_ptr<Stream> stream) : stream_(std::move(stream)) {}

  template <class Call>
  void use(Call call) {
    if (stream_.is_foreign()) throw_foreign("the live source");
    const py::gil_scoped_release unlocked;
    const std::lock_guard alone(mutex_);
    if (stream_.get() == nullptr) throw Error("the live source", "it is closed", "open it again");
    call(*stream_.get());
  }
  py::dict health() {
    StreamHealth health;
    use([&](Stream& stream) { health = stream.health(); });
    return counts_of(health);
  }
  void close() {
    const py::gil_scoped_release unlocked;
    if (stream_.is_foreign()) return;
    const std::lock_guard alone(mutex_);
    stream_.reset();
  }

 private:
  std::mutex mutex_;
  ProcessBound<Stream> stream_;
};

/// A live source, used by one thread at a time.
class LiveFrames {
 public:
  LiveFrames(const std::string& source, const std::optional<Skin>& skin, std::uint32_t serial_baud,
             const std::string& layout, std::optional<Pitch> pitch_mm, bool falling,
             std::optional<double> timeout_s) {
    const py::gil_scoped_release unlocked;
    LiveSourceOptions options;
    options.skin = skin;
    options.serial_baud = serial_baud;
    options.read.layout = layout_in(layout);
    options.read.sensel_pitch_mm = pitch_mm;
    options.read.falling = falling;
    options.say = [&](const std::string& note) { notes_.push_back(note); };
    if (timeout_s) options.most_wait = nanoseconds_of(*timeout_s);
    SignalCheck check_signals;
    options.stop = [&] { return check_signals(), false; };
    auto stream = open_live_source(source, options);
    skin_ = stream->skin();
    sensel_type_ = stream->sensel_type();
    frame_ = std::make_unique<StreamedFrame>(sensel_type_, skin_);
    stream_.emplace(std::move(stream));
  }

  /// The next frame as (readings, time, sequence, missing); None where none came in time. Throws
  /// StopIteration at the end.
  py::object next(double timeout_s) {
    return wait_for_next(timeout_s, [&](auto patience) { return next_within(patience); });
  }
  [[nodiscard]] py::dict health() { return stream_->health(); }
  void close() { stream_->close(); }
  [[nodiscard]] const Skin& skin() const { return skin_; }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
  [[nodiscard]] SenselType sensel_type() const { return sensel_type_; }

 private:
  py::object next_within(std::chrono::nanoseconds patience) {
    py::array readings(dtype_of(sensel_type_), Shape{skin_.rows, skin_.cols});
    auto* const copy = static_cast<std::byte*>(readings.mutable_data());
    Arrival arrival = Arrival::timed_out;
    std::vector<std::array<std::uint32_t, 4>> missing;
    double time_s = 0;
    std::uint64_t sequence = 0;
    stream_->use([&](FrameStream& stream) {
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

  std::optional<SharedStream<FrameStream>> stream_;
  Skin skin_;
  std::vector<std::string> notes_;
  SenselType sensel_type_ = SenselType::u8;
  std::unique_ptr<StreamedFrame> frame_;
};

/// The results of another program, used by one thread at a time.
class LiveResults {
 public:
  explicit LiveResults(const std::string& source) {
    const py::gil_scoped_release unlocked;
    SignalCheck check_signals;
    auto stream = open_result_stream(source, [&] { return check_signals(), false; });
    if (stream == nullptr) {
      throw Error(source, "it holds frames, not results", "open it with live()");
    }
    skin_ = stream->skin();
    stream_.emplace(std::move(stream));
  }

  /// The planes of the next result, with its time and contacts; None where none came in time.
  py::object next(double timeout_s) {
    return wait_for_next(timeout_s, [&](auto patience) { return next_within(patience); });
  }
  [[nodiscard]] py::dict health() { return stream_->health(); }
  void close() { stream_->close(); }
  [[nodiscard]] const Skin& skin() const { return skin_; }

 private:
  py::object next_within(std::chrono::nanoseconds patience) {
    auto result = std::make_unique<StreamedResult>();
    bool came = false;
    stream_->use([&](ResultStream& stream) { came = stream.next(*result, patience); });
    if (!came) return py::none();
    const StreamedResult& kept = *result;
    py::dict planes = lent_planes(kept.forces.view(), capsule_of(std::move(result)));
    planes["times"] = kept.time_s;
    if (kept.contacts) planes["contacts"] = std::make_shared<FrameContacts>(*kept.contacts);
    return planes;
  }

  std::optional<SharedStream<ResultStream>> stream_;
  Skin skin_;
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
      .def(py::init<const std::string&, const std::optional<Skin>&, std::uint32_t,
                    const std::string&, std::optional<Pitch>, bool, std::optional<double>>(),
           py::arg("source"), py::arg("skin"), py::arg("serial_baud"), py::arg("layout"),
           py::arg("pitch_mm"), py::arg("falling"), py::arg("timeout_s"))
      .def("next", &LiveFrames::next, py::arg("timeout_s"))
      .def_property_readonly("health", &LiveFrames::health,
                             "What came and what did not: frames, lost, incomplete, late, ..., "
                             "rate_hz; as mismatch, the size of frames that came instead, or ''.")
      .def("close", &LiveFrames::close, "Closes the source.")
      .def_property_readonly("skin", &LiveFrames::skin,
                             "Skin with the rows and columns of the frames, for a Plan")
      .def_property_readonly("notes", &LiveFrames::notes,
                             "What its user should know, one sentence each")
      .def_property_readonly(
          "sensel_type", [](const LiveFrames& self) { return name_of(self.sensel_type()); },
          "'uint8', 'uint16' or 'float32', for a Plan");
  py::class_<LiveResults>(module, "LiveResults", kLiveResults)
      .def(py::init<const std::string&>(), py::arg("source"))
      .def("next", &LiveResults::next, py::arg("timeout_s"))
      .def_property_readonly("health", &LiveResults::health,
                             "What came and what did not: frames, lost, overrun, restarts, ...; as "
                             "mismatch, the size of results that came instead, or ''.")
      .def("close", &LiveResults::close, "Closes the source.")
      .def_property_readonly("skin", &LiveResults::skin,
                             "Skin with its size, layout and pitch; the rest is not known");
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
