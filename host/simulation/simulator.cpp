#include "pillarfield/simulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <span>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "pillarfield/error.h"
#include "pillarfield/status.h"
#include "simulation/closed_form/contact_traction.h"
#include "simulation/closed_form/direction_sweep.h"
#include "simulation/effects/memory_history.h"
#include "simulation/effects/pillar_model.h"
#include "simulation/ideal_readings.h"
#include "simulation/indenter/indenter_history.h"
#include "simulation/scene/scene_limits.h"
#include "simulation/sensor.h"

namespace pillarfield {
namespace {

/// Threads that render the next frames into a ring of buffers while the caller takes the earlier
/// ones; the caller renders too where its frame is not claimed yet.
class RenderAhead {
 public:
  /// Frames `first` to `first` + `count` - 1; `in_order`: one frame at a time, for scenes whose
  /// frames depend on the one before. `threads` is at least 1.
  RenderAhead(const Simulator& simulator, std::uint64_t first, std::uint64_t count,
              unsigned threads, bool in_order);
  ~RenderAhead();
  RenderAhead(const RenderAhead&) = delete;
  RenderAhead& operator=(const RenderAhead&) = delete;

  /// Calls `take` for each frame; once.
  void deliver(const Simulator::TakeFrame& take);

 private:
  struct Frame {
    FrameBuffer raw;
    ForceField truth;
    bool rendered = false;
    std::exception_ptr failed = nullptr;
  };
  using Lock = std::unique_lock<std::mutex>;

  void help();
  [[nodiscard]] bool may_claim() const;
  /// Renders the next frame; releases the lock meanwhile.
  void render_next(Lock& lock);
  [[nodiscard]] Frame& place_of(std::uint64_t number) { return ring_[number % ring_.size()]; }

  const Simulator& simulator_;
  const std::uint64_t first_;
  const std::uint64_t count_;
  const bool in_order_;
  std::mutex mutex_;  ///< guards the members below
  std::condition_variable changed_;
  std::vector<Frame> ring_;
  std::uint64_t claimed_ = 0;
  std::uint64_t taken_ = 0;
  std::uint64_t busy_ = 0;  ///< frames being rendered
  bool stopped_ = false;
  std::vector<std::jthread> helpers_;  ///< last: they use the other members
};

RenderAhead::RenderAhead(const Simulator& simulator, std::uint64_t first, std::uint64_t count,
                         unsigned threads, bool in_order)
    : simulator_(simulator), first_(first), count_(count), in_order_(in_order) {
  const Skin& skin = simulator.scene().skin;
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(count, std::uint64_t{threads} + 2); ++i) {
    ring_.push_back({.raw = FrameBuffer(simulator.sensel_type(), skin.rows, skin.cols),
                     .truth = ForceField(skin)});
  }
  try {
    for (unsigned i = 1; i < threads && i < count; ++i) helpers_.emplace_back([this] { help(); });
  } catch (const std::system_error&) {
    // The limit of threads is reached; the caller renders.
  }
}

RenderAhead::~RenderAhead() {
  {
    const std::scoped_lock lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
}

bool RenderAhead::may_claim() const {
  return claimed_ < count_ && claimed_ < taken_ + ring_.size() && !(in_order_ && busy_ > 0);
}

void RenderAhead::render_next(Lock& lock) {
  const std::uint64_t number = claimed_++;
  Frame& frame = place_of(number);
  ++busy_;
  lock.unlock();
  try {
    simulator_.render(first_ + number, frame.raw, frame.truth);
  } catch (...) {
    frame.failed = std::current_exception();
  }
  lock.lock();
  --busy_;
  frame.rendered = true;
  changed_.notify_all();
}

void RenderAhead::help() {
  Lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopped_ || claimed_ == count_ || may_claim(); });
    if (stopped_ || claimed_ == count_) return;
    render_next(lock);
  }
}

void RenderAhead::deliver(const Simulator::TakeFrame& take) {
  Lock lock(mutex_);
  for (std::uint64_t number = 0; number < count_; ++number) {
    Frame& frame = place_of(number);
    while (!frame.rendered) {
      if (may_claim()) {
        render_next(lock);
      } else {
        changed_.wait(lock);
      }
    }
    lock.unlock();
    if (frame.failed) std::rethrow_exception(frame.failed);
    take(first_ + number, frame.raw.view(), frame.truth);
    lock.lock();
    frame.rendered = false;
    ++taken_;
    changed_.notify_all();
  }
}

Scene checked(Scene scene) {
  scene.skin.surface = surface_of(scene);
  if (!scene.skin.full_scale_counts) scene.skin.full_scale_counts = full_scale_of(scene.sensor);
  check(scene, "scene");
  return scene;
}

void clear(ForceField& field) {
  for (std::vector<float>* plane : {&field.shear_x, &field.shear_y, &field.normal}) {
    std::fill(plane->begin(), plane->end(), 0.0F);
  }
  std::fill(field.status.begin(), field.status.end(), std::uint8_t{0});
}

void scale(ForceField& field, double factor) {
  if (factor == 1) return;
  for (std::vector<float>* plane : {&field.shear_x, &field.shear_y, &field.normal}) {
    for (float& force : *plane) force = static_cast<float>(force * factor);
  }
}

void add_forces(const IndenterForces& forces, ForceField& field, PressureMoments& moments) {
  const auto add = [](double force_n, float& to) { to = static_cast<float>(to + force_n); };
  for (const IndenterForce& force : forces) {
    add(force.shear_x, field.shear_x[force.pillar]);
    add(force.shear_y, field.shear_y[force.pillar]);
    add(force.normal, field.normal[force.pillar]);
    if (moments.empty()) continue;
    moments.x[force.pillar] += force.moment_x;
    moments.y[force.pillar] += force.moment_y;
  }
}

/// V of sensels without pillars: a sensel answers compression alone.
void read_sensels(std::span<const float> normal, const Scene& scene, std::span<double> signal) {
  std::ranges::transform(normal, signal.begin(), [&](float force_n) {
    return scene.skin.counts_per_newton * std::max(0.0, static_cast<double>(force_n));
  });
}

/// The load of a frame.
struct FrameLoad {
  ForceField& forces;
  PressureMoments moments;  ///< empty unless pillars need them
};

/// True if no pillar of `count` from `first` on bears a force.
bool is_untouched(const ForceField& truth, std::size_t first, std::size_t count) {
  std::uint32_t any = 0;
  for (const std::vector<float>* plane : {&truth.shear_x, &truth.shear_y, &truth.normal}) {
    for (std::size_t i = first; i < first + count; ++i) {
      any |= std::bit_cast<std::uint32_t>((*plane)[i]) << 1;  // without its sign
    }
  }
  return any == 0;
}

/// Sets V of the two sensel rows under a row of pillars and their status bytes.
void read_pillars(std::uint32_t row, const Scene& scene, const PillarModel& pillars,
                  FrameLoad& load, std::span<double> signal) {
  constexpr std::uint32_t kGroup = 32;
  ForceField& truth = load.forces;
  const std::span<double> upper = signal.first(scene.skin.cols);
  const std::span<double> lower = signal.last(scene.skin.cols);
  std::ranges::fill(signal, 0.0);
  const std::size_t first = std::size_t{row} * truth.cols;
  const auto read = [&](std::uint32_t col) {
    const std::size_t pillar = first + col;
    double_precision::Force force = {truth.shear_x[pillar], truth.shear_y[pillar],
                                     truth.normal[pillar]};
    if (!pillars.is_ideal()) force = pillars.force_on_sensels(truth, load.moments, row, col);
    if (force.normal == 0 && force.shear_x == 0 && force.shear_y == 0) return;
    const double_precision::Readings v = ideal_readings(force, scene.skin.counts_per_newton);
    truth.status[pillar] = usable_bits(v);
    const std::size_t left = std::size_t{2} * col;
    upper[left] = v.v2;
    upper[left + 1] = v.v1;
    lower[left] = v.v3;
    lower[left + 1] = v.v4;
  };
  for (std::uint32_t begin = 0; begin < truth.cols; begin += kGroup) {
    const std::uint32_t end = std::min(begin + kGroup, truth.cols);
    if (pillars.is_ideal() && is_untouched(truth, first + begin, end - begin)) continue;
    for (std::uint32_t col = begin; col < end; ++col) read(col);
  }
}

}  // namespace

struct Simulator::State {
  explicit State(Scene given)
      : scene(checked(std::move(given))), pillars(scene.sensor.effects), sensor(scene) {
    if (MemoryHistory::is_needed(scene.sensor)) memory = std::make_unique<MemoryHistory>(scene);
    if (const DirectionSweep* sweep = std::get_if<DirectionSweep>(&scene.load))
      sweep_truth = direction_sweep_forces(*sweep);
    for (std::size_t number = 0; number < scene.indenters.size(); ++number) {
      indenters.push_back(std::make_unique<IndenterHistory>(scene, number));
    }
  }

  /// Fills the three planes of force, and clears the status bytes.
  [[nodiscard]] FrameLoad load(std::uint64_t index, ForceField& truth) const {
    FrameLoad load{truth, pillars.needs_moments() ? PressureMoments(scene.skin.elements())
                                                  : PressureMoments()};
    if (const DirectionSweep* sweep = std::get_if<DirectionSweep>(&scene.load)) {
      truth = sweep_truth;
      scale(truth, factor_at(*sweep, time_of(index)));
      return load;
    }
    if (!scene.skin.has_pillars()) {
      for (auto* plane : {&truth.shear_x, &truth.shear_y}) plane->resize(truth.elements());
    }
    clear(truth);
    const double pitch_mm = scene.skin.element_pitch_mm().col_mm;
    for (const ClosedFormContact& contact : std::get<std::vector<ClosedFormContact>>(scene.load)) {
      const ContactKey state = state_at(contact, time_of(index));
      add_contact(contact, state, pitch_mm, truth);
      if (!load.moments.empty()) {
        add_pressure_moments(contact, state, pitch_mm, truth.rows, truth.cols, load.moments);
      }
    }
    for (const std::unique_ptr<IndenterHistory>& indenter : indenters) {
      add_forces(*indenter->forces(index), truth, load.moments);
    }
    return load;
  }

  /// V of all sensels after Sensor::load().
  [[nodiscard]] std::vector<double> loaded_sensels(std::uint64_t index, ForceField& truth) const {
    const Skin& skin = scene.skin;
    FrameLoad frame_load = load(index, truth);
    std::vector<double> signal(skin.sensels());
    if (!skin.has_pillars()) {
      read_sensels(truth.normal, scene, signal);
    } else {
      for (std::uint32_t row = 0; row < skin.pillar_rows(); ++row) {
        const std::size_t first = std::size_t{2} * row * skin.cols;
        read_pillars(row, scene, pillars, frame_load,
                     std::span(signal).subspan(first, std::size_t{2} * skin.cols));
      }
    }
    sensor.load(signal);
    return signal;
  }

  void render_frame(std::uint64_t index, FrameBuffer& raw, ForceField& truth) const {
    std::vector<double> signal = loaded_sensels(index, truth);
    if (memory) {
      memory->apply(index, signal, [&](std::uint64_t earlier) {
        ForceField forces(scene.skin);
        return loaded_sensels(earlier, forces);
      });
    }
    sensor.read_frame(index, signal, raw);
  }

  void render_rows(std::uint64_t index, FrameBuffer& raw, ForceField& truth) const {
    const Skin& skin = scene.skin;
    FrameLoad frame_load = load(index, truth);
    if (!skin.has_pillars()) return render_sensel_rows(index, truth.normal, raw);
    std::vector<double> signal(std::size_t{2} * skin.cols);
    const std::span<double> upper = std::span(signal).first(skin.cols);
    for (std::uint32_t row = 0; row < skin.pillar_rows(); ++row) {
      read_pillars(row, scene, pillars, frame_load, signal);
      sensor.read_row(index, 2 * row, upper, raw);
      sensor.read_row(index, 2 * row + 1, std::span(signal).last(skin.cols), raw);
    }
    if (skin.rows % 2 != 0) {
      std::ranges::fill(upper, 0.0);
      sensor.read_row(index, skin.rows - 1, upper, raw);
    }
  }

  void render_sensel_rows(std::uint64_t index, std::span<const float> normal,
                          FrameBuffer& raw) const {
    std::vector<double> signal(scene.skin.cols);
    for (std::uint32_t row = 0; row < scene.skin.rows; ++row) {
      read_sensels(normal.subspan(std::size_t{row} * scene.skin.cols, scene.skin.cols), scene,
                   signal);
      sensor.read_row(index, row, signal, raw);
    }
  }

  [[nodiscard]] double time_of(std::uint64_t index) const {
    return static_cast<double>(index) / scene.rate_hz;
  }

  void check_buffers(const FrameView& raw, const ForceField& truth) const {
    const Skin& skin = scene.skin;
    if (raw.rows != skin.rows || raw.cols != skin.cols || raw.type != sensor.sensel_type()) {
      throw Error("frame",
                  fmt::format("has {} x {} readings of {}", raw.rows, raw.cols, name_of(raw.type)),
                  fmt::format("the scene needs {} x {} of {}", skin.rows, skin.cols,
                              name_of(sensor.sensel_type())));
    }
    if (truth.rows != skin.element_rows() || truth.cols != skin.element_cols()) {
      throw Error("truth", fmt::format("has {} x {} elements", truth.rows, truth.cols),
                  fmt::format("the scene needs {} x {}", skin.element_rows(), skin.element_cols()));
    }
  }

  Scene scene;
  PillarModel pillars;
  Sensor sensor;
  std::unique_ptr<MemoryHistory> memory;  ///< null without hysteresis and creep
  ForceField sweep_truth;                 ///< empty where the load is not a sweep
  std::vector<std::unique_ptr<IndenterHistory>> indenters;
};

Simulator::Simulator(Scene scene) : state_(std::make_unique<State>(std::move(scene))) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

const Scene& Simulator::scene() const { return state_->scene; }
SenselType Simulator::sensel_type() const { return state_->sensor.sensel_type(); }
const Calibration& Simulator::calibration() const { return state_->sensor.calibration(); }

double Simulator::time_of(std::uint64_t index) const { return state_->time_of(index); }

void Simulator::render(std::uint64_t index, FrameBuffer& raw, ForceField& truth) const {
  state_->check_buffers(raw.view(), truth);
  if (state_->sensor.needs_frames()) {
    state_->render_frame(index, raw, truth);
  } else {
    state_->render_rows(index, raw, truth);
  }
  if (state_->scene.skin.has_pillars()) return;
  truth.shear_x.clear();
  truth.shear_y.clear();
  std::ranges::transform(truth.normal, truth.status.begin(), [](float force_n) {
    return force_n > 0 ? status::kSensel1 : std::uint8_t{0};
  });
}

void Simulator::render_all(std::uint64_t first, std::uint64_t count, const TakeFrame& take,
                           unsigned threads) const {
  constexpr unsigned kMostWorkers = 16;
  const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
  const unsigned workers = std::min(threads == 0 ? processors : threads, kMostWorkers);
  RenderAhead(*this, first, count, workers, state_->memory != nullptr).deliver(take);
}

}  // namespace pillarfield
