#include "streams/ring/ring_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <bit>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <mutex>
#include <random>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

thread_local CutGuard* guard_of_thread = nullptr;
struct sigaction handler_before = {};

}  // namespace

CutGuard::CutGuard() {
  static std::mutex installing;
  const std::scoped_lock lock(installing);
  struct sigaction now = {};
  sigaction(SIGBUS, nullptr, &now);
  if ((now.sa_flags & SA_SIGINFO) != 0 && now.sa_sigaction == on_bus_error) return;
  handler_before = now;
  struct sigaction action = {};
  action.sa_sigaction = on_bus_error;
  action.sa_flags = SA_SIGINFO;
  sigemptyset(&action.sa_mask);
  sigaction(SIGBUS, &action, nullptr);
}

void CutGuard::begin() { guard_of_thread = this; }

void CutGuard::end() {
  if (guard_of_thread == this) guard_of_thread = nullptr;
}

void CutGuard::on_bus_error(int /*signal*/, siginfo_t* info, void* /*context*/) {
  if (guard_of_thread != nullptr && guard_of_thread->replace(info->si_addr)) return;
  // The access is repeated, and ends as it would have without this class.
  sigaction(SIGBUS, &handler_before, nullptr);
}

bool CutGuard::replace(const void* accessed) {
  const auto* const at = static_cast<const std::byte*>(accessed);
  if (at < memory_.data() || at >= memory_.data() + memory_.size()) return false;
  is_cut_ = 1;
  return mmap(memory_.data(), memory_.size(), PROT_READ | PROT_WRITE,
              MAP_PRIVATE | MAP_FIXED | MAP_ANONYMOUS, -1, 0) != MAP_FAILED;
}

namespace {

std::uint64_t draw_session() {
  std::random_device random;
  return (std::uint64_t{random()} << 32) | random() | 1;
}

template <class T>
void store(T& member, T value) {
  std::atomic_ref(member).store(value, std::memory_order_release);
}

}  // namespace

RingWriter::RingWriter(const std::string& name, const RingLayout& layout, std::uint32_t slots)
    : name_("shm:" + name), segment_name_(segment_name(name)) {
  const auto content = content_bytes(layout);
  if (!content) throw Error(name_, "the skin is too large for a ring", "use a smaller one");
  layout_.magic = PILLARFIELD_RING_MAGIC;
  layout_.kind = layout.kind;
  layout_.rows = layout.rows;
  layout_.cols = layout.cols;
  layout_.type = layout.pitch_mm.is_square()
                     ? layout.type
                     : std::bit_cast<std::uint32_t>(static_cast<float>(layout.pitch_mm.row_mm));
  layout_.pitch_mm = layout.pitch_mm.col_mm;
  layout_.slots = slots;
  layout_.slot_bytes = (*content + 63) / 64 * 64;
  guard_.begin();
  // Another process may unlink the segment between two steps.
  for (int attempts = 0; !open(); ++attempts) {
    if (attempts == 100) throw Error(name_, "is unlinked again and again", "give another name");
  }
  number_ = ring().published;
  ring().session = draw_session();
  store(ring().closed, 0U);
  guard_.end();
}

RingWriter::~RingWriter() { close(); }

PillarfieldRing& RingWriter::ring() const {
  return *reinterpret_cast<PillarfieldRing*>(memory_.data());
}

/// Opens or creates the segment of the name; false if it must be tried again.
bool RingWriter::open() {
  segment_ = Descriptor(shm_open(segment_name_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  struct stat status = {};
  if (!segment_.is_open() || fstat(segment_.get(), &status) != 0 || status.st_uid != geteuid()) {
    throw Error(name_, "the shared memory belongs to another user", "give another name");
  }
  if (flock(segment_.get(), LOCK_EX | LOCK_NB) != 0) {
    throw Error(name_, "another program writes this ring", "give another name");
  }
  const std::uint64_t bytes = sizeof layout_ + layout_.slots * layout_.slot_bytes;
  fstat(segment_.get(), &status);
  if (status.st_nlink == 0) return false;
  const auto size = static_cast<std::uint64_t>(status.st_size);
  PillarfieldRing unfinished = layout_;
  unfinished.magic = 0;
  if (size == 0) {
    // Written at once, so that what a writer killed from here on leaves is known as a ring.
    if (pwrite(segment_.get(), &unfinished, sizeof unfinished, 0) < 0) {
      throw Error(name_, std::strerror(errno), "free some memory");
    }
  } else if (!holds_ring(size)) {
    throw Error(name_, "the shared memory is not a ring of Pillarfield", "give another name");
  }
  if (size == 0 || size == bytes) allocate(bytes);
  memory_ = Mapping(segment_, bytes, true);
  guard_.watch({memory_.data(), bytes});
  if (memory_.data() == nullptr) throw Error(name_, std::strerror(errno), "free some memory");
  if (size == 0) {
    ring() = unfinished;
    store(ring().magic, PILLARFIELD_RING_MAGIC);
    return true;
  }
  if (size == bytes && std::memcmp(&ring(), &layout_, offsetof(PillarfieldRing, session)) == 0 &&
      ring().pitch_mm == layout_.pitch_mm) {
    return true;
  }
  shm_unlink(segment_name_.c_str());
  return false;
}

/// True if the segment holds a ring, or one that its writer did not finish.
bool RingWriter::holds_ring(std::uint64_t bytes) const {
  PillarfieldRing found = {};
  if (pread(segment_.get(), &found, sizeof found, 0) != sizeof found) return false;
  if (found.magic == PILLARFIELD_RING_MAGIC) return true;
  if (found.magic != 0) return false;
  found.magic = PILLARFIELD_RING_MAGIC;
  const std::uint64_t all = sizeof found + found.slots * found.slot_bytes;
  return is_valid(found, all) && (bytes == sizeof found || bytes == all);
}

/// Allocates all memory of the segment; the segment of a killed writer may lack some.
void RingWriter::allocate(std::uint64_t bytes) {
  const int failure = posix_fallocate(segment_.get(), 0, static_cast<off_t>(bytes));
  if (failure != 0) {
    shm_unlink(segment_name_.c_str());
    throw Error(name_, fmt::format("{} bytes of shared memory: {}", bytes, std::strerror(failure)),
                "free some of /dev/shm");
  }
}

std::span<std::byte> RingWriter::begin() {
  guard_.begin();
  std::byte* const slot = memory_.data() + slot_offset(layout_, number_);
  std::atomic_ref(*reinterpret_cast<std::uint64_t*>(slot))
      .store(2 * number_ + 1, std::memory_order_relaxed);
  std::atomic_thread_fence(std::memory_order_release);
  return {slot, layout_.slot_bytes};
}

bool RingWriter::publish() {
  std::byte* const slot = memory_.data() + slot_offset(layout_, number_);
  store(*reinterpret_cast<std::uint64_t*>(slot), 2 * number_ + 2);
  ++number_;
  store(ring().published, number_);
  store(ring().signal, static_cast<std::uint32_t>(number_));
  wake_waiting(reinterpret_cast<std::byte*>(&ring().signal));
  guard_.end();
  return !guard_.is_cut();
}

void RingWriter::close() {
  if (memory_.data() == nullptr) return;
  guard_.begin();
  store(ring().closed, 1U);
  guard_.end();
  wake_waiting(reinterpret_cast<std::byte*>(&ring().signal));
  // Another segment may have the name by now.
  const Descriptor named(shm_open(segment_name_.c_str(), O_RDONLY | O_CLOEXEC, 0));
  struct stat ours = {};
  struct stat status = {};
  if (named.is_open() && fstat(named.get(), &status) == 0 && fstat(segment_.get(), &ours) == 0 &&
      status.st_ino == ours.st_ino) {
    shm_unlink(segment_name_.c_str());
  }
  memory_ = Mapping();
  segment_.reset();
}

}  // namespace pillarfield
