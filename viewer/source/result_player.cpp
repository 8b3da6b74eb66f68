#include <atomic>
#include <mutex>
#include <thread>
#include <utility>

#include "pillarfield/error.h"
#include "viewer/source/live_player.h"
#include "viewer/source/object_pool.h"
#include "viewer/source/shown_contacts.h"

namespace pillarfield::viewer {
namespace {

using ResultTime = std::chrono::nanoseconds;

/// Time that a change of the wanted planes may go unnoticed while no result comes.
constexpr ResultTime kPatience = std::chrono::milliseconds(50);

ResultTime now_of_results() { return std::chrono::steady_clock::now().time_since_epoch(); }

SourceInfo results_info(const std::string& name, const Skin& skin) {
  SourceInfo info;
  info.name = name;
  info.kind = "results";
  info.skin = skin;
  info.has_angles = skin.has_pillars();
  info.solver = "another program";
  info.contacts.layout = skin.layout;
  return info;
}

class ResultPlayer final : public LiveView {
 public:
  ResultPlayer(std::unique_ptr<ResultStream> stream, const std::string& name,
               std::shared_ptr<Curves> curves)
      : LiveView(std::move(curves)),
        stream_(std::move(stream)),
        info_(results_info(name, stream_->skin())),
        found_here_(info_.skin.element_pitch_mm(), info_.contacts),
        blocks_(FieldProducer::kMostShown,
                [this] {
                  return std::make_unique<PlaneBlock>(info_.skin.layout, info_.skin.element_rows(),
                                                      info_.skin.element_cols(), false);
                }),
        thread_([this] { run(); }) {}
  ~ResultPlayer() override {
    stopping_ = true;
    thread_.join();
  }

  [[nodiscard]] const SourceInfo& info() const override { return info_; }
  [[nodiscard]] PlayerState state() const override {
    const PlayerStatistics counts = statistics();
    return state_after(counts.produced, counts.produced_hz);
  }
  /// Does nothing but say who can.
  void tare() override {
    const std::scoped_lock lock(mutex_);
    status_.message = info_.name + ": the tare is taken by the program that solves the frames";
    ++status_.messages;
  }
  void record(const std::filesystem::path& /*path*/) override {
    throw Error(info_.name, "it holds results, not frames",
                "record by the program that solves them: stream --record");
  }
  void stop_recording() override {}
  [[nodiscard]] LiveStatus status() override;

 private:
  // Run in the thread.
  void run();
  void add();
  void publish();
  [[nodiscard]] std::shared_ptr<const ShownContacts> contacts_of(const ShownField& field);

  const std::unique_ptr<ResultStream> stream_;
  const SourceInfo info_;
  // Members of the thread.
  StreamedResult result_;
  ShownField shown_;  ///< with the planes of `result_`
  ContactLabels map_;
  FieldContacts found_here_;  ///< contacts where the ring has none
  ObjectPool<PlaneBlock> blocks_;

  std::atomic<bool> stopping_ = false;
  std::mutex mutex_;  ///< guards the next two members
  LiveStatus status_;
  ResultTime arrived_ = now_of_results();  ///< of the newest result

  std::thread thread_;  ///< last: uses the other members
};

void ResultPlayer::run() {
  try {
    bool with_contacts = wants_contacts_;
    while (!stopping_) {
      const bool came = stream_->next(result_, kPatience);
      if (came) add();
      const bool changed = std::exchange(with_contacts, wants_contacts_) != with_contacts;
      if ((came || (changed && stream_->health().frames > 0)) && !paused_) publish();
      const std::scoped_lock lock(mutex_);
      status_.health.stream = stream_->health();
      if (came) arrived_ = result_.arrived;
    }
  } catch (...) {
    newest_.end(std::current_exception());
  }
}

/// Measures the result that came.
void ResultPlayer::add() {
  shown_ = {};
  shown_.forces = result_.forces.view();
  shown_.time_s = clock_.time_s(result_.time_s, result_.arrived);
  shown_.index = stream_->health().frames - 1;
  shown_.arrived = result_.arrived;
  measure(shown_);
}

/// Hands a copy of the newest result to the display.
void ResultPlayer::publish() {
  const std::shared_ptr<PlaneBlock> block = blocks_.acquire();
  if (block == nullptr) return;
  block->copy(result_.forces.view());
  ShownField field = shown_;
  field.forces = block->view();
  field.pages = block->pages();
  field.keep_alive = block;
  if (wants_contacts_) field.contacts = contacts_of(field);
  newest_.set(std::move(field));
}

std::shared_ptr<const ShownContacts> ResultPlayer::contacts_of(const ShownField& field) {
  if (!result_.contacts) {
    return std::make_shared<const ShownContacts>(found_here_.contacts_of(field));
  }
  map_.find(field.forces.status, field.forces.rows, field.forces.cols);
  FrameContacts found = *result_.contacts;
  std::erase_if(found.contacts,
                [&](const TrackedContact& contact) { return contact.label >= map_.contacts(); });
  return std::make_shared<const ShownContacts>(with_extents(std::move(found), map_));
}

LiveStatus ResultPlayer::status() {
  const double rate_hz = statistics().produced_hz;
  const std::scoped_lock lock(mutex_);
  LiveStatus status = status_;
  status.health.stream.rate_hz = rate_hz;
  status.health.solved = status.health.stream.frames;
  status.health.since_frame_s = std::chrono::duration<double>(now_of_results() - arrived_).count();
  return status;
}

}  // namespace

std::unique_ptr<Player> play_results(std::unique_ptr<ResultStream> stream, const std::string& name,
                                     std::shared_ptr<Curves> curves) {
  return std::make_unique<ResultPlayer>(std::move(stream), name, std::move(curves));
}

}  // namespace pillarfield::viewer
