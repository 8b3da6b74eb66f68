#include "device/packed_results.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include "pillarfield/status.h"

namespace pillarfield {
namespace {

// As in kernels/frame/pack_results.cl.
constexpr std::size_t kGroupPillars = 64;
constexpr std::size_t kCountBytes = 64;
constexpr std::size_t kIndexBytes = 16;

}  // namespace

PackedResults::PackedResults(Device::State& device, const cl::CommandQueue& queue,
                             const ResultLayout& layout, cl::Buffer results, std::byte* pages,
                             ThreadPool& pool)
    : layout_(layout),
      planes_(layout.status / layout.plane_bytes),
      pillars_(std::size_t{layout.rows} * layout.cols),
      groups_((pillars_ + kGroupPillars - 1) / kGroupPillars),
      group_bytes_(kIndexBytes + kGroupPillars * (planes_ * sizeof(float) + 1)),
      pages_(pages),
      pool_(pool),
      results_(std::move(results)),
      sent_(device.context, CL_MEM_READ_WRITE, layout.bytes),
      packed_(device.context, CL_MEM_READ_WRITE, kCountBytes + groups_ * group_bytes_),
      packed_on_host_(device.context, queue, kCountBytes + groups_ * group_bytes_),
      kernel_(device.program(std::string(pack_program())), "pack_results"),
      stride_(layout.cols / kGroupPillars + 2) {
  std::memset(pages_, 0, layout.bytes);
  idle_.assign(layout.rows * stride_, 1);
  queue.enqueueFillBuffer(sent_, cl_uchar{0}, 0, layout.bytes);
  kernel_.setArg(0, results_);
  kernel_.setArg(1, sent_);
  kernel_.setArg(2, packed_);
  kernel_.setArg(3, static_cast<cl_ulong>(layout.plane_bytes));
  kernel_.setArg(4, static_cast<cl_uint>(planes_));
  kernel_.setArg(5, static_cast<cl_uint>(pillars_));
  kernel_.setArg(6, cl_uint{status::kAmbiguous});
}

void PackedResults::download(const cl::CommandQueue& queue) {
  constexpr std::size_t kSpare = 16;  // groups
  queue.enqueueFillBuffer(packed_, cl_uint{0}, 0, sizeof(cl_uint));
  queue.enqueueNDRangeKernel(kernel_, cl::NullRange, cl::NDRange(groups_ * kGroupPillars),
                             cl::NDRange(kGroupPillars));
  takes_planes_ = 4 * count_ > groups_;
  expected_ = takes_planes_ ? 0 : std::min(groups_, count_ + count_ / 4 + kSpare);
  queue.enqueueReadBuffer(packed_, CL_FALSE, 0, kCountBytes + expected_ * group_bytes_,
                          packed_on_host_.data());
  if (takes_planes_) queue.enqueueReadBuffer(results_, CL_FALSE, 0, layout_.bytes, pages_);
  is_pending_ = true;
}

bool PackedResults::fetch_rest(const cl::CommandQueue& queue) {
  if (!is_pending_) return false;
  cl_uint count = 0;
  std::memcpy(&count, packed_on_host_.data(), sizeof count);
  count_ = count;
  if (takes_planes_ || count_ <= expected_) return false;
  const std::size_t begin = kCountBytes + expected_ * group_bytes_;
  queue.enqueueReadBuffer(packed_, CL_FALSE, begin, (count_ - expected_) * group_bytes_,
                          packed_on_host_.data() + begin);
  expected_ = count_;
  return true;
}

void PackedResults::unpack() {
  constexpr std::size_t kPiece = 64;  // groups that a thread takes at once
  if (!is_pending_) return;
  is_pending_ = false;
  const std::size_t groups = takes_planes_ ? groups_ : count_;
  pool_.run((groups + kPiece - 1) / kPiece, [&](std::size_t piece, std::size_t) {
    const std::size_t end = std::min(groups, (piece + 1) * kPiece);
    for (std::size_t at = piece * kPiece; at < end; ++at) takes_planes_ ? mark(at) : take(at);
  });
}

/// Copies the group at a place of the packed ones into its planes.
void PackedResults::take(std::size_t place) {
  const std::byte* from = packed_on_host_.data() + kCountBytes + place * group_bytes_;
  cl_uint group = 0;
  std::memcpy(&group, from, sizeof group);
  from += kIndexBytes;
  const std::size_t first = group * kGroupPillars;
  const std::size_t pillars = std::min(kGroupPillars, pillars_ - first);
  for (std::size_t plane = 0; plane < planes_; ++plane, from += kGroupPillars * sizeof(float)) {
    std::memcpy(pages_ + plane * layout_.plane_bytes + first * sizeof(float), from,
                pillars * sizeof(float));
  }
  std::memcpy(pages_ + layout_.status + first, from, pillars);
  mark(group);
}

/// Notes whether a group is idle, in each row that has pillars of it.
void PackedResults::mark(std::size_t group) {
  const std::size_t first = group * kGroupPillars;
  const std::size_t end = std::min(first + kGroupPillars, pillars_);
  const std::byte* const status = pages_ + layout_.status;
  const bool idle = std::all_of(status + first, status + end,
                                [](std::byte bits) { return bits == std::byte{0}; });
  for (std::size_t row = first / layout_.cols; row * layout_.cols < end; ++row) {
    idle_[row * stride_ + group - row * layout_.cols / kGroupPillars] = idle ? 1 : 0;
  }
}

IdleBlocks PackedResults::idle() const { return {idle_, stride_, kGroupPillars}; }

}  // namespace pillarfield
