#include "contacts/parallel_contact_moments.h"

#include <algorithm>
#include <atomic>
#include <thread>

namespace pillarfield {
namespace {

/// Least number of pillars of a part that is split off, and of a batch: a few microseconds of work,
/// below which waking a thread does not pay.
constexpr std::uint64_t kLeastBatchPillars = 2048;

std::size_t threads_for(std::uint32_t wanted) {
  return wanted != 0 ? wanted : std::max(std::thread::hardware_concurrency(), 1U);
}

}  // namespace

ParallelContactMoments::ParallelContactMoments(std::uint32_t threads)
    : threads_(threads_for(threads)) {}

/// Splits contacts into parts and groups parts into batches of about kLeastBatchPillars.
void ParallelContactMoments::split(const ContactLabels& labels) {
  parts_.clear();
  batches_.assign(1, 0);
  std::uint64_t batched = 0;
  for (std::uint32_t contact = 0; contact < labels.contacts(); ++contact) {
    const std::span<const ContactRun> runs = labels.runs(contact);
    std::size_t first = 0;
    std::uint64_t pillars = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      pillars += runs[i].end - runs[i].first;
      if (pillars < kLeastBatchPillars && i + 1 < runs.size()) continue;
      parts_.push_back({contact, runs.subspan(first, i + 1 - first), {}});
      first = i + 1;
      batched += pillars;
      pillars = 0;
      if (batched < kLeastBatchPillars) continue;
      batches_.push_back(parts_.size());
      batched = 0;
    }
  }
  if (batches_.back() < parts_.size()) batches_.push_back(parts_.size());
}

/// Calls `test_of` for the contacts that begin in a batch.
void ParallelContactMoments::test(std::size_t batch, std::size_t member,
                                  const SlipTestOf& test_of) {
  for (std::size_t i = batches_[batch]; i < batches_[batch + 1]; ++i) {
    const std::uint32_t contact = parts_[i].contact;
    if (i > 0 && parts_[i - 1].contact == contact) continue;  // Done at its first part.
    tests_[contact] = test_of(contact, member);
    std::atomic_ref(is_tested_[contact]).store(true, std::memory_order_release);
  }
}

/// Sums the parts of a batch. Their tests are done, or other threads do them.
void ParallelContactMoments::sum(std::size_t batch, const ForceFieldView& forces) {
  for (std::size_t i = batches_[batch]; i < batches_[batch + 1]; ++i) {
    Part& part = parts_[i];
    while (!std::atomic_ref(is_tested_[part.contact]).load(std::memory_order_acquire)) {
      std::this_thread::yield();
    }
    part.sum = sum_of(forces, part.runs, tests_[part.contact]);
  }
}

const std::vector<ContactSum>& ParallelContactMoments::measure(const ForceFieldView& forces,
                                                               const ContactLabels& labels,
                                                               const SlipTestOf& test_of) {
  split(labels);
  tests_.assign(labels.contacts(), {});
  is_tested_.assign(labels.contacts(), false);
  const std::size_t batches = batches_.size() - 1;
  // All tests come before the sums, so that a thread that waits for one waits for another thread.
  const auto work = [&](std::size_t piece, std::size_t member) {
    piece < batches ? test(piece, member, test_of) : sum(piece - batches, forces);
  };
  if (threads_ == 1 || batches < 2) {
    for (std::size_t piece = 0; piece < 2 * batches; ++piece) work(piece, 0);
  } else {
    if (!pool_) pool_ = std::make_unique<ThreadPool>(threads_);
    pool_->run(2 * batches, work);
  }
  sums_.assign(labels.contacts(), {});
  for (const Part& part : parts_) sums_[part.contact].add(part.sum);
  return sums_;
}

}  // namespace pillarfield
