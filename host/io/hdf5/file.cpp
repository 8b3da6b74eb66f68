#include "io/hdf5/file.h"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>

#include "io/file_kind.h"
#include "io/hdf5/attribute.h"
#include "io/hdf5/crash_guard.h"
#include "io/hdf5/stored_frames.h"
#include "pillarfield/error.h"

namespace pillarfield::hdf5 {
namespace {

constexpr const char* kLayout = "docs/formats.md describes the expected file";
constexpr const char* kCannotWrite = "cannot be written";
constexpr const char* kFlushedBytes = "flushed_bytes";
constexpr const char* kFlushedFrames = "flushed_frames";

std::string advice_for(std::string_view found, std::string_view wanted) {
  if (found == "pillarfield-forces") {
    return "it holds solved forces; pass the recording that they were solved from";
  }
  if (found == "pillarfield-calibration") {
    return "it holds a calibration; pass the recording that it is for";
  }
  if (found != "pillarfield-recording") return kLayout;
  return wanted == "pillarfield-calibration" ? "it holds readings; calibrate with them first"
                                             : "it holds readings; solve it first";
}

/// Limits retries to 25, which take 33 ms. By default HDF5 retries metadata that a writer may be
/// changing 100 times and doubles each wait, which never ends in a damaged file.
Handle patient_access(const InputFile& input, bool unclosed) {
  constexpr unsigned kReadAttempts = 25;
  Handle access = reading_access(input);
  if (unclosed) H5Pset_metadata_read_attempts(access.get(), kReadAttempts);
  return access;
}

std::uint64_t size_of(const std::filesystem::path& path) {
  std::error_code failed;
  const auto bytes = std::filesystem::file_size(path, failed);
  if (!failed) return bytes;
  throw Error(path.string(), failed.message(), "do not move it while it is open");
}

Handle create_note(const File& file, const char* name) {
  constexpr hsize_t kOne = 1;
  const Handle one = own(H5Screate_simple(1, &kOne, nullptr), file.path, kCannotWrite);
  const Handle layout = creation_properties(file, H5P_DATASET_CREATE);
  return own(H5Dcreate2(file.id.get(), name, H5T_STD_U64LE, one.get(), H5P_DEFAULT, layout.get(),
                        H5P_DEFAULT),
             file.path, kCannotWrite);
}

void note(const File& file, const Handle& dataset, std::uint64_t number) {
  require(H5Dwrite(dataset.get(), H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &number),
          file.path, kCannotWrite);
  require(H5Dflush(dataset.get()), file.path, kCannotWrite);
}

/// The size before the frames: a writer that is killed between the two has lost nothing that it
/// has noted.
void note_flushed(const File& file, std::uint64_t frames) {
  note(file, file.flushed_bytes, size_of(file.path));
  note(file, file.flushed_frames, frames);
}

std::optional<std::uint64_t> noted(const File& file, const char* name) {
  if (!exists(file, name)) return std::nullopt;
  const StoredFrames number(file, name, 0);
  std::uint64_t value = 0;
  if (number.frames() > 0) number.get(0, H5T_NATIVE_UINT64, &value);
  return value;
}

/// Throws Error if an unclosed file is shorter than its writer had flushed.
void require_whole(const File& file) {
  const auto flushed = noted(file, kFlushedBytes);
  if (!flushed) return;
  const std::uint64_t bytes = size_of(file.path);
  if (bytes >= *flushed) return;
  throw Error(file.path.string(),
              fmt::format("lost its end: {} bytes are left of {}", bytes, *flushed), kDamaged);
}

}  // namespace

File open_to_read(const InputFile& input, bool trusted) {
  const std::filesystem::path& path = input.path();
  if (detect_format(input).kind != FileKind::hdf5) {
    throw Error(path.string(), "is not an HDF5 file", kLayout);
  }
  const WriterState state = writer_state(input);
  if (state == WriterState::abandoned) {
    throw Error(path.string(), "was not closed by its writer and holds no flushed data",
                "wait for the writer, or write it again");
  }
  File file;
  const CrashGuard guard(path, trusted);
  file.path = path;
  file.trusted = trusted;
  file.unclosed = state == WriterState::swmr;
  const unsigned mode = H5F_ACC_RDONLY | (file.unclosed ? H5F_ACC_SWMR_READ : 0u);
  const Handle access = patient_access(input, file.unclosed);
  file.id =
      own(H5Fopen(path.c_str(), mode, access.get()), path, "cannot be opened as HDF5", kDamaged);
  if (!file.unclosed) return file;
  // Frames first: a running writer notes them last.
  file.readable_frames = noted(file, kFlushedFrames).value_or(file.readable_frames);
  require_whole(file);
  return file;
}

std::optional<std::string> format_of(const std::filesystem::path& path) {
  const QuietErrors quiet;
  const CrashGuard guard(path, false, CrashGuard::kNoLimit);
  try {
    const File file = open_to_read(InputFile(path), false);
    return Attributes(file).text("format").value_or("");
  } catch (const Error&) {
    return std::nullopt;
  }
}

int require_format(const File& file, std::string_view format, int newest) {
  const auto found = Attributes(file).text("format");
  if (!found) {
    throw Error(file.path.string(),
                fmt::format("is an HDF5 file but not a {}: it has no attribute 'format'", format),
                kLayout);
  }
  if (*found != format) {
    throw Error(file.path.string(), fmt::format("its format is '{:.60}', not '{}'", *found, format),
                advice_for(*found, format));
  }
  const auto version = Attributes(file).number("version");
  if (!version) throw Error(file.path.string(), "has no attribute 'version'", kLayout);
  for (int known = 1; known <= newest; ++known) {
    if (*version == known) return known;
  }
  throw Error(file.path.string(),
              fmt::format("its version is {}; this program reads version 1{}", *version,
                          newest > 1 ? fmt::format(" to {}", newest) : ""),
              "use a newer program");
}

File create(const OutputFile& output) {
  const std::filesystem::path& path = output.part_path();
  File file;
  file.path = path;
  file.write_status = std::make_shared<WriteStatus>();
  const Handle access = fault_tolerant_access(file.write_status, output);
  require(H5Pset_libver_bounds(access.get(), H5F_LIBVER_LATEST, H5F_LIBVER_LATEST), path,
          kCannotWrite);
  const Handle creation = creation_properties(file, H5P_FILE_CREATE);
  file.id = own(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), path,
                kCannotWrite, "close it in other programs");
  return file;
}

void start_appending(File& file) {
  file.flushed_bytes = create_note(file, kFlushedBytes);
  file.flushed_frames = create_note(file, kFlushedFrames);
  note_flushed(file, 0);
  flush(file);  // HDF5 reads back what it has written
  require(H5Fstart_swmr_write(file.id.get()), file.path, kCannotWrite);
  require_written(*file.write_status, file.path);
}

void flush(const File& file) {
  require(H5Fflush(file.id.get(), H5F_SCOPE_GLOBAL), file.path, kCannotWrite);
  require_written(*file.write_status, file.path);
}

void flush(const File& file, std::uint64_t frames) {
  flush(file);
  note_flushed(file, frames);
}

void close(File& file) {
  (void)file.flushed_bytes.close();
  (void)file.flushed_frames.close();
  if (!file.id.close()) fail(file.path, kCannotWrite);
  require_written(*file.write_status, file.path);
}

Handle creation_properties(const File& file, hid_t kind) {
  Handle properties = own(H5Pcreate(kind), file.path, kCannotWrite);
  require(H5Pset_obj_track_times(properties.get(), false), file.path, kCannotWrite);
  return properties;
}

Handle create_group(const File& file, const char* name) {
  const Handle creation = creation_properties(file, H5P_GROUP_CREATE);
  return own(H5Gcreate2(file.id.get(), name, H5P_DEFAULT, creation.get(), H5P_DEFAULT), file.path,
             kCannotWrite);
}

namespace {

herr_t refuse_external_link(const char*, const char*, const char*, const char*, unsigned*, hid_t,
                            void*) {
  return -1;
}

/// An access list that forbids links to other files: such a file could be a FIFO, whose open never
/// returns, or one that the reader may see and the sender may not.
Handle access_within_file(const File& file) {
  constexpr const char* kFailure = "HDF5 does not accept a rule for links";
  Handle access = own(H5Pcreate(H5P_LINK_ACCESS), file.path, kFailure);
  require(H5Pset_elink_cb(access.get(), refuse_external_link, nullptr), file.path, kFailure);
  return access;
}

/// True if the link `path`, whose parents are valid, leads to an object of this file.
bool leads_within_file(const File& file, const std::string& path, const Handle& access) {
  H5L_info_t link = {};
  require(H5Lget_info(file.id.get(), path.c_str(), &link, access.get()), file.path,
          fmt::format("{} cannot be looked up", path), kDamaged);
  if (link.type == H5L_TYPE_HARD) return true;
  return link.type == H5L_TYPE_SOFT &&
         H5Oexists_by_name(file.id.get(), path.c_str(), access.get()) > 0;
}

}  // namespace

bool exists(const File& file, std::string_view path) {
  const CrashGuard guard(file.path, file.trusted);
  const Handle access = access_within_file(file);
  // HDF5 checks one link at a time.
  for (std::size_t end = 1; end != std::string_view::npos;) {
    end = path.find('/', end + 1);
    const std::string parent(path.substr(0, end));
    const htri_t found = H5Lexists(file.id.get(), parent.c_str(), access.get());
    require(found, file.path, fmt::format("{} cannot be looked up", parent), kDamaged);
    if (found == 0) return false;
    if (leads_within_file(file, parent, access)) continue;
    throw Error(file.path.string(),
                fmt::format("{} is a link that leads to another file or nowhere", parent),
                "copy its target into this file");
  }
  return true;
}

Handle open_object(const File& file, const char* path) {
  if (!exists(file, path)) {
    throw Error(file.path.string(), fmt::format("has no {}", path),
                "docs/formats.md lists the required objects");
  }
  const CrashGuard guard(file.path, file.trusted);
  const Handle access = access_within_file(file);
  return own(H5Oopen(file.id.get(), path, access.get()), file.path,
             fmt::format("{} cannot be opened", path), kDamaged);
}

}  // namespace pillarfield::hdf5
