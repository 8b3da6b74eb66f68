#include "streams/ring/ring_reader.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <thread>
#include <utility>

#include "pillarfield/error.h"
#include "streams/source/sessions.h"

namespace pillarfield {
namespace {

using namespace std::chrono_literals;

/// Longest time for which a replaced ring may go unnoticed.
constexpr RingReader::Time kLongestWait = 50ms;

RingReader::Time now_of_ring() { return std::chrono::steady_clock::now().time_since_epoch(); }

/// A ring that cannot be read as this content.
[[noreturn]] void throw_unfit(const std::string& name, RingReader::Content content,
                              const PillarfieldRing& ring, bool valid) {
  using Content = RingReader::Content;
  constexpr std::uint32_t kFirstResults = 2;  // two kinds in each layout
  if (ring.magic == PILLARFIELD_RING_MAGIC && content != Content::frames &&
      ring.kind >= kFirstResults && ring.kind < PILLARFIELD_RING_RESULTS) {
    throw Error(name, "it holds results in the layout of an earlier version",
                "let this version write it");
  }
  if (valid && content == Content::frames) {
    throw Error(name, "it holds results, not frames",
                "open the ring of the sensor, or of stream --relay");
  }
  if (valid) throw Error(name, "it holds frames, not results", "open the ring of stream --to");
  constexpr std::array kContents = {"frames or results", "frames", "results"};
  throw Error(name,
              fmt::format("is not a ring of {}", kContents[static_cast<std::size_t>(content)]),
              "docs/stream_format.md describes the ring");
}

}  // namespace

RingReader::RingReader(const std::string& name, Content content)
    : name_("shm:" + name), segment_name_(segment_name(name)), content_(content) {}

template <class T>
T RingReader::load(std::size_t offset) const {
  T value{};
  if (pread(segment_.get(), &value, sizeof value, static_cast<off_t>(offset)) !=
      static_cast<ssize_t>(sizeof value)) {
    value = {};
  }
  std::atomic_thread_fence(std::memory_order_acquire);
  return value;
}

bool RingReader::open() { return segment_.is_open() || attach(); }

/// Opens the segment of the name; false if there is none yet, or none that fits.
bool RingReader::attach() {
  // A pipe in its place must not wait for a writer.
  Descriptor segment(shm_open(segment_name_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK, 0));
  if (!segment.is_open()) {
    if (errno == ENOENT || layout_) return false;
    throw Error(name_, fmt::format("cannot be opened: {}", std::strerror(errno)),
                "only the user who made the ring reads it");
  }
  struct stat status = {};
  fstat(segment.get(), &status);
  if (!S_ISREG(status.st_mode)) {
    if (layout_) return false;
    throw Error(name_, "is no shared memory", "remove it from /dev/shm, or give another name");
  }
  const bool is_foreign = status.st_uid != geteuid() && status.st_uid != 0;
  if (is_foreign && !layout_) {
    throw Error(name_, "belongs to another user", "give the name of a ring of your own");
  }
  std::swap(segment_, segment);
  const auto ring = load<PillarfieldRing>(0);
  if (ring.magic != 0 && !is_foreign && fits(ring, static_cast<std::uint64_t>(status.st_size))) {
    head_ = Mapping(segment_, sizeof ring, false);
  }
  if (head_.data() == nullptr) {
    // Its writer may be about to fill it; any other counts once.
    if (ring.magic != 0 && std::exchange(rejected_inode_, status.st_ino) != status.st_ino) {
      ++invalid_;
    }
    segment_.reset();
    return false;
  }
  ring_ = ring;
  const bool is_first = !layout_;
  if (is_first) {
    layout_ = layout_of(ring);
    slot_.resize(*content_bytes(*layout_));
  }
  const std::uint64_t kept = is_first ? 1 : ring_.slots - 1;
  next_ = ring_.published - std::min<std::uint64_t>(ring_.published, kept);
  return true;
}

bool RingReader::is_wanted(const RingLayout& layout) const {
  return content_ == Content::any || holds_results(layout) == (content_ == Content::results);
}

bool RingReader::fits(const PillarfieldRing& ring, std::uint64_t bytes) {
  const RingLayout layout = layout_of(ring);
  const bool valid = is_valid(ring, bytes);
  const bool wanted = valid && is_wanted(layout);
  if (wanted && layout_ && layout != *layout_) other_ = layout;
  if (layout_) return wanted && layout == *layout_;
  if (wanted) return true;
  throw_unfit(name_, content_, ring, valid);
}

void RingReader::detach() {
  head_ = Mapping();
  segment_.reset();
}

bool RingReader::is_replaced() const {
  struct stat status = {};
  return fstat(segment_.get(), &status) != 0 || status.st_nlink == 0 ||
         !is_valid(load<PillarfieldRing>(0), static_cast<std::uint64_t>(status.st_size));
}

/// For readers that poll: looks at most every kLongestWait, so that polling stays cheap.
void RingReader::detach_if_replaced() {
  const Time now = now_of_ring();
  if (now - checked_ < kLongestWait) return;
  checked_ = now;
  if (is_replaced()) detach();
}

void RingReader::skip_to(std::uint64_t number) {
  if (number - next_ <= kFarAhead) overrun_ += number - next_;  // else a new count
  next_ = number;
}

/// Copies the slot of `next_`; false if it is overwritten.
bool RingReader::copy_next() {
  const std::uint64_t offset = slot_offset(ring_, next_);
  const auto bytes = static_cast<ssize_t>(slot_.size());
  if (pread(segment_.get(), slot_.data(), slot_.size(), static_cast<off_t>(offset)) != bytes) {
    return false;
  }
  std::atomic_thread_fence(std::memory_order_acquire);
  return load<std::uint64_t>(offset) == 2 * next_ + 2;
}

void RingReader::wait(std::uint32_t signal, Time timeout) {
  if (timeout <= 0ns) return;
  const Time slice = std::min(timeout, kLongestWait);
  const Time start = now_of_ring();
  wait_for_word(head_.data() + offsetof(PillarfieldRing, signal), signal, slice);
  if (now_of_ring() - start < slice) return;
  if (is_replaced()) detach();
}

const std::byte* RingReader::read(Time timeout) {
  const Time until = now_of_ring() + timeout;
  // A segment that changes without rest ends the loop too.
  for (int attempts = 0; attempts < 1000; ++attempts) {
    const Time left = until - now_of_ring();
    if (!open()) {
      if (left <= 0ns) return nullptr;
      std::this_thread::sleep_for(std::min<Time>(left, 10ms));
      attempts = 0;
      continue;
    }
    const auto signal = load<std::uint32_t>(offsetof(PillarfieldRing, signal));
    const auto published = load<std::uint64_t>(offsetof(PillarfieldRing, published));
    if (published < next_) next_ = published;  // A new writer restarts the count.
    if (published == next_) {
      if (left <= 0ns) {
        detach_if_replaced();
        return nullptr;
      }
      wait(signal, left);
      continue;
    }
    if (copy_next()) {
      ++next_;
      return slot_.data();
    }
    const auto newest = load<std::uint64_t>(offsetof(PillarfieldRing, published)) - 1;
    skip_to(newest > next_ ? newest : next_ + 1);
  }
  return nullptr;
}

}  // namespace pillarfield
