#include "pillarfield/result_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <thread>

#include "pillarfield/error.h"
#include "pillarfield/printable.h"
#include "streams/ring/ring_contact.h"
#include "streams/ring/ring_reader.h"

namespace pillarfield {
namespace {

using namespace std::chrono_literals;

constexpr std::string_view kResultsPrefix = "shm:";

Skin skin_of(const RingLayout& ring) {
  Skin skin;
  skin.layout = ring.kind == PILLARFIELD_RING_RESULTS ? SkinLayout::pillars : SkinLayout::sensels;
  const std::uint32_t side = skin.has_pillars() ? 2 : 1;
  skin.rows = side * ring.rows;
  skin.cols = side * ring.cols;
  skin.sensel_pitch_mm = (1.0 / side) * ring.pitch_mm;
  return skin;
}

class RingResults final : public ResultStream {
 public:
  explicit RingResults(RingReader reader)
      : reader_(std::move(reader)), skin_(skin_of(*reader_.layout())) {}

  [[nodiscard]] const Skin& skin() const override { return skin_; }
  [[nodiscard]] bool next(StreamedResult& result, std::chrono::nanoseconds timeout) override;
  [[nodiscard]] StreamHealth health() const override;

 private:
  void count(std::uint64_t sequence);
  void copy_planes(ForceField& forces, const std::byte* planes) const;
  [[nodiscard]] std::optional<FrameContacts> contacts_of(const PillarfieldResultSlot& head) const;

  RingReader reader_;
  Skin skin_;
  StreamHealth health_;
  std::uint64_t next_sequence_ = 0;
};

bool RingResults::next(StreamedResult& result, std::chrono::nanoseconds timeout) {
  const std::byte* const slot = reader_.read(timeout);
  if (slot == nullptr) return false;
  PillarfieldResultSlot head;
  std::memcpy(&head, slot, sizeof head);
  count(head.sequence);
  result.sequence = head.sequence;
  result.time_s = std::isfinite(head.time_s) ? head.time_s : 0;
  const std::chrono::nanoseconds now = std::chrono::steady_clock::now().time_since_epoch();
  result.arrived =
      std::chrono::nanoseconds(std::min(head.arrived_ns, static_cast<std::uint64_t>(now.count())));
  copy_planes(result.forces, slot + sizeof head);
  head.time_s = result.time_s;
  result.contacts = contacts_of(head);
  result.contacts_found = head.contacts_found;
  return true;
}

void RingResults::count(std::uint64_t sequence) {
  if (health_.frames > 0 && sequence < next_sequence_) ++health_.restarts;
  if (health_.frames > 0 && sequence > next_sequence_) health_.lost += sequence - next_sequence_;
  ++health_.frames;
  next_sequence_ = sequence + 1;
}

void RingResults::copy_planes(ForceField& forces, const std::byte* planes) const {
  if (forces.rows != skin_.element_rows() || forces.cols != skin_.element_cols() ||
      forces.shear_x.empty() == skin_.has_pillars()) {
    forces = ForceField(skin_);
  }
  const auto copy = [&](auto& plane) {
    const std::size_t bytes = plane.size() * sizeof plane[0];
    if (bytes > 0) std::memcpy(plane.data(), planes, bytes);
    planes += bytes;
  };
  copy(forces.shear_x);
  copy(forces.shear_y);
  copy(forces.normal);
  copy(forces.status);
}

std::optional<FrameContacts> RingResults::contacts_of(const PillarfieldResultSlot& head) const {
  if (!std::isfinite(head.total.area_mm2)) return std::nullopt;
  FrameContacts found;
  found.time_s = head.time_s;
  found.total = contact_from(head.total, head.time_s, skin_.layout).quantities;
  const std::uint32_t count = std::min(head.contacts, PILLARFIELD_MAX_CONTACTS);
  for (std::uint32_t i = 0; i < count; ++i) {
    found.contacts.push_back(contact_from(head.contact[i], head.time_s, skin_.layout));
  }
  std::ranges::sort(found.contacts, {}, &TrackedContact::label);
  return found;
}

StreamHealth RingResults::health() const {
  StreamHealth health = health_;
  health.overrun = reader_.overrun();
  health.invalid = reader_.invalid();
  if (const auto& other = reader_.other()) {
    const RingLayout& ours = *reader_.layout();
    health.mismatch = fmt::format("results are {} x {} of {} mm, {} x {} of {} mm expected",
                                  other->rows, other->cols, text_of(other->pitch_mm), ours.rows,
                                  ours.cols, text_of(ours.pitch_mm));
  }
  return health;
}

}  // namespace

std::unique_ptr<ResultStream> open_result_stream(const std::string& source,
                                                 const std::function<bool()>& stop) {
  if (!source.starts_with(kResultsPrefix)) {
    throw Error(printable(source), "it is not a ring of results", "give shm:NAME");
  }
  RingReader reader(source.substr(kResultsPrefix.size()), RingReader::Content::any);
  while (!reader.open()) {
    if (stop && stop()) return nullptr;
    std::this_thread::sleep_for(100ms);
  }
  if (!holds_results(*reader.layout())) return nullptr;
  return std::make_unique<RingResults>(std::move(reader));
}

}  // namespace pillarfield
