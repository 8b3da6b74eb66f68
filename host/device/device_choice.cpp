// Selection of a device.

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cctype>
#include <charconv>

#include "device/device_race.h"
#include "device/device_state.h"
#include "device/kernel_cache.h"
#include "lanes/lane_plan.h"
#include "skin/quads.h"
#include "solve/whole_numbers.h"

namespace pillarfield {
namespace {

constexpr int kLanesOfCpu = 16;
constexpr std::string_view kHost = "host";
constexpr std::string_view kAnyOpenCl = "opencl";
/// Blocks of 2 x 2 sensels up to which the host's lanes solve a plan sooner than an OpenCL device
/// on the same processor: any, or one in whole numbers (docs/decisions/host_lanes.md).
constexpr std::size_t kMostQuadsOnHost = 16384;
constexpr std::size_t kMostWholeQuadsOnHost = 65536;
constexpr const char* kPoclPlatform = "Portable Computing Language";

const char* type_name(cl_device_type type) {
  if ((type & CL_DEVICE_TYPE_GPU) != 0) return "GPU";
  if ((type & CL_DEVICE_TYPE_CPU) != 0) return "CPU";
  if ((type & CL_DEVICE_TYPE_ACCELERATOR) != 0) return "accelerator";
  return "other";
}

/// True if the version, such as "OpenCL 1.2 pocl ...", is at least 1.2.
bool speaks_opencl_1_2(const std::string& version) {
  constexpr std::string_view kPrefix = "OpenCL ";
  if (!version.starts_with(kPrefix) || version.size() < kPrefix.size() + 3) return false;
  const char major = version[kPrefix.size()];
  const char minor = version[kPrefix.size() + 2];
  return major > '1' || (major == '1' && minor >= '2');
}

std::string reason_against(const cl::Device& device) {
  if (device.getInfo<CL_DEVICE_AVAILABLE>() == CL_FALSE) return "it is not available";
  if (device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>() == CL_FALSE) return "it has no compiler";
  const std::string version = device.getInfo<CL_DEVICE_VERSION>();
  if (!speaks_opencl_1_2(version)) return "it offers " + version + ", 1.2 is needed";
  if (device.getInfo<CL_DEVICE_ENDIAN_LITTLE>() == CL_FALSE) return "it is big-endian";
  return {};
}

DeviceInfo describe(const cl::Platform& platform, const cl::Device& device, int index) {
  DeviceInfo info;
  info.index = index;
  const cl_device_type type = device.getInfo<CL_DEVICE_TYPE>();
  info.name = device.getInfo<CL_DEVICE_NAME>();
  info.platform = platform.getInfo<CL_PLATFORM_NAME>();
  info.version = device.getInfo<CL_DEVICE_VERSION>();
  info.type = type_name(type);
  info.lanes = (type & CL_DEVICE_TYPE_CPU) != 0 ? kLanesOfCpu : 1;
  info.shares_memory = device.getInfo<CL_DEVICE_HOST_UNIFIED_MEMORY>() == CL_TRUE;
  info.unsuitable = reason_against(device);
  if (info.platform == kPoclPlatform) {
    const KernelCache& cache = kernel_cache();
    if (cache.not_kept.empty()) info.kernel_cache = cache.directory.string();
    info.kernels_not_kept = cache.not_kept;
  }
  return info;
}

/// Remedies where no driver is found.
std::string mend_no_device() {
  const KernelCache& cache = kernel_cache();
  if (cache.directory.empty()) {
    return fmt::format(
        "PoCL needs a directory that only you can write, for compiled kernels, and there is none "
        "({}): name one with POCL_CACHE_DIR",
        cache.not_kept);
  }
  constexpr const char* kInstall =
      "install an OpenCL driver, for instance the Debian package pocl-opencl-icd, or take --device "
      "host";
  rlimit space{};
  if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY) {
    return fmt::format(
        "drivers may not fit into the address space, which is limited to {} MiB: raise the limit "
        "(ulimit -v), or {}",
        space.rlim_cur >> 20U, kInstall);
  }
  return kInstall;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), [](unsigned char character) {
    return static_cast<char>(std::tolower(character));
  });
  return lower;
}

/// One clause per device, for messages.
std::string enumerate(const std::vector<Candidate>& candidates) {
  std::string text;
  for (const auto& [info, device] : candidates) {
    text += fmt::format("{}{}: {} ({}, {})", text.empty() ? "" : ", ", info.index, info.name,
                        info.type, info.unsuitable.empty() ? "suitable" : info.unsuitable);
  }
  return text;
}

int rank(const DeviceInfo& info) {
  if (info.type == "GPU") return 0;
  if (info.type == "accelerator") return 1;
  return info.type == "CPU" ? 2 : 3;
}

bool is_named(const Candidate& candidate, std::string_view index_or_name) {
  int index = -1;
  const char* const end = index_or_name.data() + index_or_name.size();
  const auto parsed = std::from_chars(index_or_name.data(), end, index);
  if (parsed.ec == std::errc{} && parsed.ptr == end) return candidate.info.index == index;
  return lower_case(candidate.info.name).find(lower_case(index_or_name)) != std::string::npos;
}

/// The best suitable device, or the first with this name.
const Candidate* choose(const std::vector<Candidate>& candidates, std::string_view wanted) {
  const Candidate* best = nullptr;
  for (const Candidate& candidate : candidates) {
    if (!wanted.empty() && !is_named(candidate, wanted)) continue;
    if (!candidate.info.unsuitable.empty()) continue;
    if (best == nullptr || rank(candidate.info) < rank(best->info)) best = &candidate;
  }
  return best;
}

DeviceInfo describe_host() {
  DeviceInfo info;
  info.index = -1;
  info.name = fmt::format("host, {}", lane_programs().front()->name);
  info.type = "host";
  info.lanes = lane_programs().front()->lanes;
  info.shares_memory = true;
  return info;
}

std::shared_ptr<Device::State> open_opencl(const std::vector<Candidate>& candidates,
                                           std::string_view index_or_name) {
  if (candidates.empty()) throw Error("OpenCL", "there is no device", mend_no_device());
  const Candidate* const chosen = choose(candidates, index_or_name);
  if (chosen == nullptr) {
    throw Error("OpenCL",
                index_or_name.empty() ? std::string("no device is suitable")
                                      : fmt::format("no suitable device is '{}'", index_or_name),
                fmt::format("there are: {}", enumerate(candidates)));
  }
  return std::make_shared<Device::State>(chosen->info, chosen->device);
}

}  // namespace

std::vector<Candidate> all_devices() {
  static_cast<void>(kernel_cache());  // Before PoCL reads the variable.
  std::vector<Candidate> candidates;
  std::vector<cl::Platform> platforms;
  try {
    cl::Platform::get(&platforms);
  } catch (const cl::Error&) {
    return candidates;  // OpenCL reports no platform as an error.
  }
  for (const cl::Platform& platform : platforms) {
    std::vector<cl::Device> devices;
    try {
      platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
    } catch (const cl::Error&) {
      continue;  // A driver without devices.
    }
    for (cl::Device& device : devices) {
      const int index = static_cast<int>(candidates.size());
      candidates.push_back({describe(platform, device, index), std::move(device)});
    }
  }
  return candidates;
}

std::vector<DeviceInfo> list_devices() {
  return with_opencl_errors("OpenCL", [] {
    std::vector<DeviceInfo> infos;
    for (const Candidate& candidate : all_devices()) infos.push_back(candidate.info);
    return infos;
  });
}

Device open_device(std::string_view wanted) {
  if (wanted.empty()) return Device(std::make_shared<Device::Best>());
  if (wanted == kHost) return Device(std::make_shared<Device::State>());
  return Device(with_opencl_errors("OpenCL", [&] {
    const std::vector<Candidate> candidates = all_devices();
    return open_opencl(candidates, wanted == kAnyOpenCl ? "" : wanted);
  }));
}

Device::State::State(DeviceInfo described, cl::Device opened)
    : info(std::move(described)), device(std::move(opened)), context(device) {}

Device::State::State() : info(describe_host()) {}

std::shared_ptr<Device::State> Device::Best::opened() {
  const std::scoped_lock lock(opening_);
  if (state_ != nullptr) return state_;
  state_ = with_opencl_errors("OpenCL", [] {
    const std::vector<Candidate> candidates = all_devices();
    const bool usable = choose(candidates, "") != nullptr;
    return usable ? open_opencl(candidates, "") : std::make_shared<State>();
  });
  return state_;
}

namespace {

/// Quotients and roots are correctly rounded, as on the host, where the device can do so: without
/// the option a GPU takes approximate ones. -w: PoCL would print how many warnings there are.
std::string build_options(const cl::Device& device) {
  const auto config = device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>();
  const bool rounds = (config & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
  return std::string("-cl-std=CL1.2 -w") +
         (rounds ? " -cl-fp32-correctly-rounded-divide-sqrt" : "");
}

}  // namespace

cl::Program Device::State::program(const std::string& source) {
  const std::scoped_lock lock(building_);
  if (const auto found = programs_.find(source); found != programs_.end()) return found->second;
  if (std::string refused = reason_not_to_compile(info); !refused.empty()) {
    throw Error(info.name, "compiled kernels cannot be written", refused);
  }
  cl::Program built(context, source);
  try {
    built.build(device, build_options(device).c_str());
  } catch (const cl::BuildError& error) {
    const auto log = error.getBuildLog();
    throw Error(info.name, "the kernel does not compile on this device",
                fmt::format("choose another device; the compiler says: {}",
                            log.empty() ? "nothing" : log.front().second));
  }
  return programs_.emplace(source, std::move(built)).first->second;
}

Device::State& Device::state() const { return best_ ? *best_->opened() : *state_; }

const DeviceInfo& Device::info() const { return state().info; }

Device Device::for_plan(const SolverPlan& plan) const {
  if (best_ == nullptr) return *this;
  const std::size_t most = is_whole(plan) ? kMostWholeQuadsOnHost : kMostQuadsOnHost;
  Device host(std::make_shared<State>());
  if (quads(plan.skin) <= most) return host;
  Device opened(best_->opened());
  if (opened.info().shares_memory) return opened;
  try {
    if (time_of_frame(opened, plan) <= time_of_frame(host, plan)) return opened;
  } catch (const Error&) {
    // The device fails or cannot hold the plan.
  }
  return host;
}

}  // namespace pillarfield
