#include "io/hdf5/driver.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#if __has_include(<H5FDdevelop.h>)
#include <H5FDdevelop.h>
#endif

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "io/output/locked_part.h"

namespace pillarfield::hdf5 {
namespace {

/// Options that the file access list passes to the driver.
struct DriverOptions {
  int descriptor = -1;                        ///< the driver uses a duplicate
  std::shared_ptr<WriteStatus> write_status;  ///< not set for reading
};

struct DriverFile : H5FD_t {
  explicit DriverFile(int file) : H5FD_t{}, descriptor(file) {}

  int descriptor;
  haddr_t allocated_end = 0;
  haddr_t metadata_at = 0;   ///< free place in the page of metadata
  haddr_t metadata_end = 0;  ///< end of that page
  haddr_t file_end = 0;
  std::vector<char> waiting;  ///< adjacent small blocks, which one call writes
  haddr_t waiting_at = 0;     ///< their address
  std::shared_ptr<WriteStatus> write_status;
};

DriverFile& ours(H5FD_t* file) { return *static_cast<DriverFile*>(file); }
const DriverFile& ours(const H5FD_t* file) { return *static_cast<const DriverFile*>(file); }

void* copy_options(const void* options) {
  return new DriverOptions(*static_cast<const DriverOptions*>(options));
}

herr_t free_options(void* options) {
  delete static_cast<DriverOptions*>(options);
  return 0;
}

H5FD_t* open_file(const char*, unsigned, hid_t access, haddr_t) {
  const auto* options = static_cast<const DriverOptions*>(H5Pget_driver_info(access));
  if (options == nullptr) return nullptr;
  const int descriptor = fcntl(options->descriptor, F_DUPFD_CLOEXEC, 0);
  struct stat found = {};
  if (descriptor < 0 || fstat(descriptor, &found) != 0) {
    if (options->write_status) options->write_status->error_number = errno;
    return nullptr;
  }
  auto file = std::make_unique<DriverFile>(descriptor);
  file->file_end = static_cast<haddr_t>(found.st_size);
  file->write_status = options->write_status;
  return file.release();
}

/// Keeps the reason of the first failed write.
void note_result(DriverFile& target, int reason) {
  if (target.write_status->error_number == 0) target.write_status->error_number = reason;
}

void write_through(DriverFile& target, haddr_t address, const char* next, std::size_t size) {
  if (size == 0 || target.write_status->error_number != 0) return;
  note_result(target, write_all(target.descriptor, std::as_bytes(std::span(next, size)), address));
}

void write_waiting(DriverFile& target) {
  write_through(target, target.waiting_at, target.waiting.data(), target.waiting.size());
  target.waiting.clear();
}

herr_t close_file(H5FD_t* file) {
  const std::unique_ptr<DriverFile> owned(&ours(file));
  write_waiting(*owned);
  if (::close(owned->descriptor) != 0 && owned->write_status) note_result(*owned, errno);
  return 0;
}

herr_t query(const H5FD_t*, unsigned long* features) {
  *features = H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_AGGREGATE_SMALLDATA |
              H5FD_FEAT_SUPPORTS_SWMR_IO | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

haddr_t allocated_end(const H5FD_t* file, H5FD_mem_t) { return ours(file).allocated_end; }

herr_t set_allocated_end(H5FD_t* file, H5FD_mem_t, haddr_t end) {
  DriverFile& target = ours(file);
  target.allocated_end = end;
  if (end < target.metadata_end) target.metadata_at = target.metadata_end;  // values may come there
  return 0;
}

/// Puts metadata into pages of their own, none across a border: a process that is killed in a call
/// leaves whole pages, and half a block would fail its checksum. The last byte of a page stays
/// free, or HDF5 would join it to the next page. Values, and metadata above a page, follow the end.
haddr_t allocate(H5FD_t* file, H5FD_mem_t type, hid_t, hsize_t size) {
  constexpr hsize_t kPageBytes = 4096;
  DriverFile& target = ours(file);
  haddr_t& end = target.allocated_end;
  if (type == H5FD_MEM_DRAW || size >= kPageBytes) return std::exchange(end, end + size);
  if (target.metadata_at + size >= target.metadata_end) {
    target.metadata_at = (end + kPageBytes - 1) / kPageBytes * kPageBytes;
    target.metadata_end = end = target.metadata_at + kPageBytes;
  }
  return std::exchange(target.metadata_at, target.metadata_at + size);
}

haddr_t file_end(const H5FD_t* file, H5FD_mem_t) { return ours(file).file_end; }

herr_t read_block(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t address, size_t size, void* block) {
  auto* out = static_cast<char*>(block);
  write_waiting(ours(file));
  while (size > 0) {
    const ssize_t got = pread(ours(file).descriptor, out, size, static_cast<off_t>(address));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return -1;
    if (got == 0) {  // allocated, but not yet in the file
      std::memset(out, 0, size);
      return 0;
    }
    out += got;
    address += static_cast<haddr_t>(got);
    size -= static_cast<size_t>(got);
  }
  return 0;
}

/// Small blocks of values wait for adjacent ones; all reach the file in their order. Metadata do
/// not wait: a process that is killed in a call leaves part of it, and each block has a checksum.
herr_t write_block(H5FD_t* file, H5FD_mem_t type, hid_t, haddr_t address, size_t size,
                   const void* block) {
  constexpr std::size_t kSmallBytes = 64 << 10;
  constexpr std::size_t kMostWaitingBytes = 1 << 20;
  DriverFile& target = ours(file);
  target.file_end = std::max<haddr_t>(target.file_end, address + size);
  const auto* const bytes = static_cast<const char*>(block);
  std::vector<char>& waiting = target.waiting;
  const bool is_adjacent = address == target.waiting_at + waiting.size();
  const bool waits = type == H5FD_MEM_DRAW && is_adjacent;
  if (!waits || waiting.size() + size > kMostWaitingBytes) write_waiting(target);
  if (type != H5FD_MEM_DRAW || (size > kSmallBytes && waiting.empty())) {
    write_through(target, address, bytes, size);
    return 0;
  }
  if (waiting.empty()) target.waiting_at = address;
  waiting.insert(waiting.end(), bytes, bytes + size);
  return 0;
}

herr_t flush_file(H5FD_t* file, hid_t, hbool_t) {
  write_waiting(ours(file));
  return 0;
}

herr_t truncate_file(H5FD_t* file, hid_t, hbool_t) {
  DriverFile& target = ours(file);
  write_waiting(target);
  if (target.file_end == target.allocated_end || target.write_status->error_number != 0) return 0;
  const int result = ftruncate(target.descriptor, static_cast<off_t>(target.allocated_end));
  note_result(target, result == 0 ? 0 : errno);
  target.file_end = target.allocated_end;
  return 0;
}

/// HDF5 marks a file as being written only if the driver can lock it.
herr_t lock_file(H5FD_t* file, hbool_t exclusive) {
  const int kind = exclusive ? LOCK_EX : LOCK_SH;
  const bool locked = flock(ours(file).descriptor, kind | LOCK_NB) == 0;
  return locked || errno == ENOSYS ? 0 : -1;
}

herr_t unlock_file(H5FD_t* file) {
  const bool unlocked = flock(ours(file).descriptor, LOCK_UN) == 0;
  return unlocked || errno == ENOSYS ? 0 : -1;
}

H5FD_class_t driver_class() {
  H5FD_class_t driver = {};
#ifdef H5FD_CLASS_VERSION  // HDF5 1.14 and later
  driver.version = H5FD_CLASS_VERSION;
  driver.value = 512;  // first unreserved value
#endif
  driver.name = "pillarfield";
  driver.maxaddr = (haddr_t{1} << 62) - 1;
  driver.fc_degree = H5F_CLOSE_WEAK;
  driver.fapl_size = sizeof(DriverOptions);
  driver.fapl_copy = copy_options;
  driver.fapl_free = free_options;
  driver.open = open_file;
  driver.close = close_file;
  driver.query = query;
  driver.alloc = allocate;
  driver.get_eoa = allocated_end;
  driver.set_eoa = set_allocated_end;
  driver.get_eof = file_end;
  driver.read = read_block;
  driver.write = write_block;
  driver.flush = flush_file;
  driver.truncate = truncate_file;
  driver.lock = lock_file;
  driver.unlock = unlock_file;
  constexpr H5FD_mem_t kPools[H5FD_MEM_NTYPES] = H5FD_FLMAP_DICHOTOMY;
  std::copy(std::begin(kPools), std::end(kPools), std::begin(driver.fl_map));
  return driver;
}

/// The driver's identifier, which stays registered: HDF5 calls a driver's close after it has
/// released the file's reference to it, so the last one must not be a file's.
hid_t registered_driver() {
  static const hid_t registered = [] {
    const H5FD_class_t driver = driver_class();
    return H5FDregister(&driver);
  }();
  return registered;
}

Handle driver_access(const DriverOptions& options, const std::filesystem::path& file) {
  constexpr const char* kFailure = "HDF5 does not accept a file driver";
  Handle access = own(H5Pcreate(H5P_FILE_ACCESS), file, kFailure);
  require(H5Pset_driver(access.get(), registered_driver(), &options), file, kFailure);
  return access;
}

}  // namespace

void require_written(const WriteStatus& write_status, const std::filesystem::path& file) {
  if (write_status.error_number != 0) fail_to_write(file, write_status.error_number);
}

Handle fault_tolerant_access(const std::shared_ptr<WriteStatus>& write_status,
                             const OutputFile& output) {
  return driver_access({output.descriptor(), write_status}, output.part_path());
}

Handle reading_access(const InputFile& input) {
  return driver_access({input.descriptor(), nullptr}, input.path());
}

}  // namespace pillarfield::hdf5
