#include "viewer/source/result_player.h"

#include <atomic>
#include <mutex>
#include <thread>
#include <utility>

#include "pillarfield/error.h"
#include "viewer/source/object_pool.h"
#include "viewer/source/plane_block.h"
#include "viewer/source/shown_contacts.h"

namespace pillarfield::viewer {
namespace {

using ResultTime = std::chrono::nanoseconds;

/// How long a change of what is wanted may go unnoticed while no result comes.
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

}  // namespace

struct ResultPlayer::State {
  State(std::unique_ptr<ResultStream> from, const std::string& name,
        std::shared_ptr<Curves> measured, NewestField& display, Wanted& asked);
  ~State();

  // Run in the thread.
  void run();
  void add();
  void publish();
  [[nodiscard]] std::shared_ptr<const ShownContacts> contacts_of(const ShownField& field);

  const std::unique_ptr<ResultStream> stream;
  const SourceInfo info;
  const std::shared_ptr<Curves> curves;
  // Of the thread.
  StreamedResult result;
  ShownField shown;  ///< with the planes of `result`
  FieldClock clock{now_of_results()};
  ContactLabels map;
  FieldContacts found_here;  ///< contacts where the ring has none
  PeakHold peak;
  ObjectPool<PlaneBlock> blocks;

  Wanted& wanted;
  std::atomic<bool> stopping = false;

  mutable std::mutex mutex;  ///< guards the members up to `messages`
  StreamHealth health;
  ResultTime arrived = now_of_results();  ///< of the newest result
  std::string message;
  std::uint64_t messages = 0;

  NewestField& newest;
  std::thread thread;  ///< last: uses the other members
};

ResultPlayer::State::State(std::unique_ptr<ResultStream> from, const std::string& name,
                           std::shared_ptr<Curves> measured, NewestField& display, Wanted& asked)
    : stream(std::move(from)),
      info(results_info(name, stream->skin())),
      curves(std::move(measured)),
      found_here(info.skin.element_pitch_mm(), info.contacts),
      blocks(FieldProducer::kMostShown,
             [this] {
               return std::make_unique<PlaneBlock>(info.skin.layout, info.skin.element_rows(),
                                                   info.skin.element_cols(), false);
             }),
      wanted(asked),
      newest(display),
      thread([this] { run(); }) {}

ResultPlayer::State::~State() {
  stopping = true;
  thread.join();
}

void ResultPlayer::State::run() {
  try {
    bool with_contacts = wanted.contacts;
    while (!stopping) {
      const bool came = stream->next(result, kPatience);
      if (came) add();
      const bool changed = std::exchange(with_contacts, wanted.contacts) != with_contacts;
      if ((came || (changed && stream->health().frames > 0)) && !wanted.paused) publish();
      const std::scoped_lock lock(mutex);
      health = stream->health();
      if (came) arrived = result.arrived;
    }
  } catch (...) {
    newest.end(std::current_exception());
  }
}

/// Measures the result that came.
void ResultPlayer::State::add() {
  shown = {};
  shown.forces = result.forces.view();
  shown.time_s = clock.time_s(result.time_s, result.arrived);
  shown.index = stream->health().frames - 1;
  shown.arrived = result.arrived;
  curves->add(shown);
  newest.count(result.arrived);
  if (!wanted.peak) return;
  if (wanted.peak_anew.exchange(false)) peak.reset();
  peak.add(result.forces.view());
}

/// Hands a copy of the newest result to the display.
void ResultPlayer::State::publish() {
  const std::shared_ptr<PlaneBlock> block = blocks.acquire();
  if (block == nullptr) return;
  block->copy(result.forces.view());
  ShownField field = shown;
  field.forces = block->view();
  field.pages = block->pages();
  field.keep_alive = block;
  if (wanted.contacts) field.contacts = contacts_of(field);
  if (wanted.peak) field.peak = peak.field(field);
  newest.set(std::move(field));
}

std::shared_ptr<const ShownContacts> ResultPlayer::State::contacts_of(const ShownField& field) {
  if (!result.contacts) {
    return std::make_shared<const ShownContacts>(found_here.contacts_of(field));
  }
  map.find(field.forces.status, field.forces.rows, field.forces.cols);
  FrameContacts found = *result.contacts;
  std::erase_if(found.contacts,
                [&](const TrackedContact& contact) { return contact.label >= map.contacts(); });
  return std::make_shared<const ShownContacts>(with_extents(std::move(found), map, {}));
}

ResultPlayer::ResultPlayer(std::unique_ptr<ResultStream> stream, const std::string& name,
                           std::shared_ptr<Curves> curves)
    : state_(
          std::make_unique<State>(std::move(stream), name, std::move(curves), newest_, wanted_)) {}

ResultPlayer::~ResultPlayer() = default;

const SourceInfo& ResultPlayer::info() const { return state_->info; }

PlayerState ResultPlayer::state() const {
  const PlayerStatistics counts = statistics();
  return state_after(counts.produced, counts.produced_hz);
}

void ResultPlayer::tare() {
  const std::scoped_lock lock(state_->mutex);
  state_->message = state_->info.name + ": the tare is taken by the program that solves the frames";
  ++state_->messages;
}

void ResultPlayer::record(const std::filesystem::path& /*path*/) {
  throw Error(state_->info.name, "it holds results, not frames",
              "record by the program that solves them: stream --record");
}

LiveStatus ResultPlayer::status() const {
  const double rate_hz = statistics().produced_hz;
  const std::scoped_lock lock(state_->mutex);
  LiveStatus status;
  status.health.stream = state_->health;
  status.health.stream.rate_hz = rate_hz;
  status.health.solved = state_->health.frames;
  status.health.since_frame_s =
      std::chrono::duration<double>(now_of_results() - state_->arrived).count();
  status.message = state_->message;
  status.messages = state_->messages;
  return status;
}

}  // namespace pillarfield::viewer
