#include "device/field_stage.h"

#include <algorithm>
#include <span>
#include <vector>

#include "core/field_work.h"

namespace pillarfield {
namespace {

constexpr std::size_t kContactGroup = 64;
constexpr std::size_t kWorkers = 1024;
constexpr std::size_t kFloatPlanes = 6;

/// A box without pillars, and what is laid around it.
constexpr std::size_t kEmptyCells = 4;

static_assert(sizeof(ContactRun) == sizeof(single_precision::Run),
              "runs go to the device as they are");

bool has_doubles(const cl::Device& device) {
  return device.getInfo<CL_DEVICE_EXTENSIONS>().find("cl_khr_fp64") != std::string::npos;
}

cl::Program build(Device::State& device, bool groups) {
  if (!has_doubles(device.device)) {
    throw Error(device.info.name, "the field estimator needs double precision, which it has not",
                "choose another device, or the direct estimator");
  }
  return device.program(field_kernel_source(groups));
}

/// What a launch for contacts works on; cells and lines as in FieldWork.
struct Contacts {
  std::span<const single_precision::Tile> tiles;
  std::span<const ContactRun> runs;
  std::size_t cells;
  std::size_t lines;
};

/// A buffer that grows with what it has to hold.
class Growing {
 public:
  const cl::Buffer& of(const cl::Context& context, std::size_t bytes) {
    if (bytes > bytes_ || bytes_ == 0) {
      bytes_ = std::max<std::size_t>(bytes + bytes / 2, 1);
      buffer_ = cl::Buffer(context, CL_MEM_READ_WRITE, bytes_);
    }
    return buffer_;
  }

 private:
  cl::Buffer buffer_;
  std::size_t bytes_ = 0;
};

class DeviceFieldStage final : public FieldStage {
 public:
  DeviceFieldStage(Device::State& device, const SolverPlan& plan, bool groups);

  void warm_up(const cl::CommandQueue& queue, SlotMemory& memory) override;
  void resolve(const cl::CommandQueue& queue, SlotMemory& memory) override;
  [[nodiscard]] const ContactMap& contacts() const override { return work_.map(); }

 private:
  cl_uint set_field(cl::Kernel& kernel, const SlotMemory& memory) const;
  void enqueue_contacts(const cl::CommandQueue& queue, const SlotMemory& memory,
                        const Contacts& contacts);
  void enqueue_pillars(const cl::CommandQueue& queue, const SlotMemory& memory,
                       std::span<const std::uint32_t> alone);
  void keep_for_next(const cl::CommandQueue& queue, const SlotMemory& memory,
                     std::span<const ContactRun> runs);
  const cl::Buffer& send_runs(const cl::CommandQueue& queue, std::span<const ContactRun> runs);

  cl::Context context_;
  std::uint32_t rows_;
  std::uint32_t cols_;
  FieldWork work_;
  std::size_t group_ = 1;    ///< work-items of a contact
  std::size_t workers_ = 1;  ///< work-items for pillars alone
  cl::Kernel contacts_;
  cl::Kernel pillars_;
  cl::Kernel keep_;
  cl::Buffer past_normal_;  ///< null where frames are not close in time
  cl::Buffer past_deviation_;
  cl::Buffer past_frame_;
  cl_uint now_ = 1;  ///< frames that were seen, and one: pillars begin with frame 0
  Growing tiles_;
  Growing runs_;
  Growing verdicts_;
  Growing kinds_;
  Growing planes_;
  Growing lines_;
  Growing shared_;
  Growing counts_;
  Growing alone_;
};

DeviceFieldStage::DeviceFieldStage(Device::State& device, const SolverPlan& plan, bool groups)
    : context_(device.context),
      rows_(plan.skin.pillar_rows()),
      cols_(plan.skin.pillar_cols()),
      work_(plan) {
  const cl::Program program = build(device, groups);
  contacts_ = cl::Kernel(program, "resolve_contacts");
  pillars_ = cl::Kernel(program, "resolve_pillars");
  keep_ = cl::Kernel(program, "keep_runs");
  if (plan.field.frames_close) {
    past_normal_ = cl::Buffer(context_, CL_MEM_READ_WRITE, plan.skin.pillars() * sizeof(float));
    past_deviation_ = cl::Buffer(context_, CL_MEM_READ_WRITE, plan.skin.pillars() * sizeof(float));
    std::vector<cl_uint> never(plan.skin.pillars());
    past_frame_ = cl::Buffer(context_, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR,
                             never.size() * sizeof(cl_uint), never.data());
  }
  if (groups) {
    group_ = std::min(kContactGroup,
                      contacts_.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device.device));
    workers_ = kWorkers;
  } else {
    workers_ = device.device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
  }
}

cl_uint DeviceFieldStage::set_field(cl::Kernel& kernel, const SlotMemory& memory) const {
  cl_uint argument = 0;
  for (std::size_t plane = 0; plane < kAllPlanes; ++plane) {
    kernel.setArg(argument++, memory.buffer(plane));
  }
  const single_precision::FieldSettings& settings = work_.settings();
  kernel.setArg(argument++, cl_uint{rows_});
  kernel.setArg(argument++, cl_uint{cols_});
  kernel.setArg(argument++, settings.noise);
  kernel.setArg(argument++, settings.quiet);
  kernel.setArg(argument++, settings.friction);
  kernel.setArg(argument++, cl_uint{settings.slips});
  kernel.setArg(argument++, cl_uint{settings.shape});
  kernel.setArg(argument++, cl_uint{settings.slip});
  kernel.setArg(argument++, cl_uint{settings.sweeps});
  kernel.setArg(argument++, settings.segment_point);
  kernel.setArg(argument++, past_normal_);
  kernel.setArg(argument++, past_deviation_);
  kernel.setArg(argument++, past_frame_);
  kernel.setArg(argument++, now_);
  return argument;
}

const cl::Buffer& DeviceFieldStage::send_runs(const cl::CommandQueue& queue,
                                              std::span<const ContactRun> runs) {
  const cl::Buffer& on_device = runs_.of(context_, runs.size_bytes());
  queue.enqueueWriteBuffer(on_device, CL_FALSE, 0, runs.size_bytes(), runs.data());
  return on_device;
}

void DeviceFieldStage::enqueue_contacts(const cl::CommandQueue& queue, const SlotMemory& memory,
                                        const Contacts& contacts) {
  const std::size_t tiles = contacts.tiles.size();
  const cl::Buffer& on_device = tiles_.of(context_, contacts.tiles.size_bytes());
  queue.enqueueWriteBuffer(on_device, CL_FALSE, 0, contacts.tiles.size_bytes(),
                           contacts.tiles.data());
  cl_uint argument = set_field(contacts_, memory);
  const std::size_t cells = contacts.cells;
  contacts_.setArg(argument++, on_device);
  contacts_.setArg(argument++, send_runs(queue, contacts.runs));
  contacts_.setArg(argument++, verdicts_.of(context_, tiles * sizeof(single_precision::Verdict)));
  contacts_.setArg(argument++, kinds_.of(context_, cells));
  contacts_.setArg(argument++, planes_.of(context_, kFloatPlanes * cells * sizeof(float)));
  contacts_.setArg(argument++, cl_ulong{cells});
  contacts_.setArg(argument++, lines_.of(context_, PF_LINE_SUMS * contacts.lines * sizeof(double)));
  contacts_.setArg(argument++, shared_.of(context_, PF_SHARED_SUMS * tiles * sizeof(double)));
  contacts_.setArg(argument++, counts_.of(context_, PF_RATIO_COUNTS * tiles * sizeof(cl_uint)));
  queue.enqueueNDRangeKernel(contacts_, cl::NullRange, cl::NDRange(tiles * group_),
                             cl::NDRange(group_));
}

void DeviceFieldStage::enqueue_pillars(const cl::CommandQueue& queue, const SlotMemory& memory,
                                       std::span<const std::uint32_t> alone) {
  const cl::Buffer& on_device = alone_.of(context_, alone.size_bytes());
  queue.enqueueWriteBuffer(on_device, CL_FALSE, 0, alone.size_bytes(), alone.data());
  cl_uint argument = set_field(pillars_, memory);
  pillars_.setArg(argument++, on_device);
  pillars_.setArg(argument++, static_cast<cl_uint>(alone.size()));
  const std::size_t workers = std::min(workers_, alone.size());
  queue.enqueueNDRangeKernel(pillars_, cl::NullRange, cl::NDRange(workers));
}

void DeviceFieldStage::keep_for_next(const cl::CommandQueue& queue, const SlotMemory& memory,
                                     std::span<const ContactRun> runs) {
  cl_uint argument = set_field(keep_, memory);
  keep_.setArg(argument++, send_runs(queue, runs));
  keep_.setArg(argument++, static_cast<cl_uint>(runs.size()));
  queue.enqueueNDRangeKernel(keep_, cl::NullRange, cl::NDRange(std::min(workers_, runs.size())));
}

void DeviceFieldStage::warm_up(const cl::CommandQueue& queue, SlotMemory& memory) {
  // A contact without rows, a pillar without a force, a run without pillars.
  const single_precision::Tile tile = {};
  const ContactRun run = {};
  const std::uint32_t pillar = 0;
  memory.release(queue);
  enqueue_contacts(queue, memory, {{&tile, 1}, {&run, 1}, kEmptyCells, 1});
  enqueue_pillars(queue, memory, {&pillar, 1});
  if (past_normal_() != nullptr) keep_for_next(queue, memory, {&run, 1});
  memory.fetch(queue);
  queue.finish();
}

void DeviceFieldStage::resolve(const cl::CommandQueue& queue, SlotMemory& memory) {
  const auto* const status = reinterpret_cast<const std::uint8_t*>(memory.host(kStatus));
  work_.find({status, std::size_t{rows_} * cols_});
  ++now_;
  const std::span<const ContactRun> runs = work_.map().runs();
  const bool keeps = past_normal_() != nullptr && !runs.empty();
  if (work_.tiles().empty() && work_.alone().empty() && !keeps) return;
  memory.release(queue);
  if (!work_.tiles().empty()) {
    enqueue_contacts(queue, memory, {work_.tiles(), runs, work_.cells(), work_.lines()});
  }
  if (!work_.alone().empty()) enqueue_pillars(queue, memory, work_.alone());
  if (keeps) keep_for_next(queue, memory, runs);
  memory.fetch(queue);
  queue.finish();
}

}  // namespace

bool shares_by_groups(const DeviceInfo& device, ContactSharing sharing) {
  if (sharing == ContactSharing::automatic) return device.type != "CPU";
  return sharing == ContactSharing::work_group;
}

std::unique_ptr<FieldStage> device_field_stage(Device::State& device, const SolverPlan& plan,
                                               bool groups) {
  return std::make_unique<DeviceFieldStage>(device, plan, groups);
}

}  // namespace pillarfield
