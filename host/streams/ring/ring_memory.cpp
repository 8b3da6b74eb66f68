#include "streams/ring/ring_memory.h"

#include <fmt/format.h>
#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <climits>
#include <ctime>
#include <utility>

#include "pillarfield/error.h"
#include "pillarfield/printable.h"

namespace pillarfield {
namespace {

constexpr std::uint64_t kMostSlots = 1 << 20;
constexpr std::uint64_t kMostSlotBytes = 1 << 30;
constexpr std::uint64_t kResultBytes = 3 * sizeof(float) + 1;  ///< of a pillar
constexpr std::uint64_t kPressureBytes = sizeof(float) + 1;    ///< of a sensel without pillars
constexpr double kLeastPitchMm = 1e-3;  ///< of a sensel, as check(Skin) has it
constexpr double kMostPitchMm = 2e3;    ///< of a pillar

std::uint64_t reading_bytes_of(std::uint32_t type) {
  switch (type) {
    case PILLARFIELD_U8:
      return 1;
    case PILLARFIELD_U16:
      return 2;
    case PILLARFIELD_F32:
      return 4;
    default:
      return 0;
  }
}

}  // namespace

bool holds_results(const RingLayout& layout) {
  return layout.kind == PILLARFIELD_RING_RESULTS || layout.kind == PILLARFIELD_RING_PRESSURES;
}

std::optional<std::uint64_t> content_bytes(const RingLayout& layout) {
  if (layout.rows < 1 || layout.cols < 1) return std::nullopt;
  const std::uint64_t elements = std::uint64_t{layout.rows} * layout.cols;
  if (elements > PILLARFIELD_MAX_SENSELS) return std::nullopt;
  if (holds_results(layout)) {
    const auto fits = [](double mm) { return mm >= kLeastPitchMm && mm <= kMostPitchMm; };
    if (!fits(layout.pitch_mm.row_mm) || !fits(layout.pitch_mm.col_mm)) return std::nullopt;
    const bool pillars = layout.kind == PILLARFIELD_RING_RESULTS;
    return sizeof(PillarfieldResultSlot) + elements * (pillars ? kResultBytes : kPressureBytes);
  }
  const std::uint64_t bytes = reading_bytes_of(layout.type);
  if (layout.kind != PILLARFIELD_RING_FRAMES || bytes == 0) return std::nullopt;
  return sizeof(PillarfieldFrameSlot) + elements * bytes;
}

std::uint32_t slots_for(const RingLayout& layout) {
  const std::uint64_t bytes = content_bytes(layout).value_or(1);
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>((64U << 20) / bytes, 4, 64));
}

RingLayout layout_of(const PillarfieldRing& ring) {
  RingLayout layout{ring.kind, ring.rows, ring.cols, ring.type};
  if (!holds_results(layout)) return layout;
  layout.pitch_mm = ring.pitch_mm;
  if (ring.type != 0) layout.pitch_mm.row_mm = double{std::bit_cast<float>(ring.type)};
  layout.type = 0;
  return layout;
}

bool is_valid(const PillarfieldRing& ring, std::uint64_t segment_bytes) {
  const auto content = content_bytes(layout_of(ring));
  if (ring.magic != PILLARFIELD_RING_MAGIC || !content) return false;
  if (ring.slots < 2 || ring.slots > kMostSlots) return false;
  if (ring.slot_bytes < *content || ring.slot_bytes > kMostSlotBytes) return false;
  if (ring.slot_bytes % 64 != 0) return false;
  return sizeof ring + ring.slots * ring.slot_bytes <= segment_bytes;
}

std::uint64_t slot_offset(const PillarfieldRing& ring, std::uint64_t number) {
  return sizeof ring + number % ring.slots * ring.slot_bytes;
}

std::string segment_name(const std::string& name) {
  constexpr std::string_view kAllowed =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-";
  if (name.empty() || name.size() > 200 || name.front() == '.' ||
      name.find_first_not_of(kAllowed) != std::string::npos) {
    throw Error("shm:" + printable(name), "is not the name of a ring",
                "give up to 200 letters, digits, '.', '_' and '-'");
  }
  return "/" + name;
}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

void Descriptor::reset() {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
}

Mapping::Mapping(const Descriptor& segment, std::uint64_t bytes, bool writable) : bytes_(bytes) {
  const int protection = writable ? PROT_READ | PROT_WRITE : PROT_READ;
  void* const mapped = mmap(nullptr, bytes, protection, MAP_SHARED, segment.get(), 0);
  if (mapped != MAP_FAILED) data_ = static_cast<std::byte*>(mapped);
}

Mapping::~Mapping() {
  if (data_ != nullptr) munmap(data_, bytes_);
}

Mapping::Mapping(Mapping&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), bytes_(other.bytes_) {}

Mapping& Mapping::operator=(Mapping&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

void wait_for_word(const std::byte* word, std::uint32_t value, std::chrono::nanoseconds timeout) {
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(timeout);
  const timespec wait = {.tv_sec = whole.count(), .tv_nsec = (timeout - whole).count()};
  syscall(SYS_futex, word, FUTEX_WAIT, value, &wait, nullptr, 0);
}

void wake_waiting(std::byte* word) {
  syscall(SYS_futex, word, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

}  // namespace pillarfield
