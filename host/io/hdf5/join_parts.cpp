#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "io/extension.h"
#include "io/file_source.h"
#include "io/force_format.h"
#include "io/force_planes.h"
#include "io/hdf5/attribute.h"
#include "io/hdf5/contact_hdf5_tables.h"
#include "io/hdf5/file.h"
#include "io/hdf5/force_info.h"
#include "io/hdf5/frames.h"
#include "io/hdf5/links.h"
#include "io/hdf5/readers.h"
#include "io/hdf5/stored_frames.h"
#include "io/hdf5/tiled_frames.h"
#include "io/hdf5/virtual_frames.h"
#include "pillarfield/error.h"
#include "pillarfield/force_file.h"
#include "pillarfield/status.h"

namespace pillarfield {
namespace {

constexpr float kNoForce = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint8_t kNoStatus = status::kInconsistent;

/// Lost parts may claim any number of frames, which the others cannot confirm: more bytes than
/// these are refused.
constexpr double kMostBytesPerFoundByte = 100;
constexpr double kAlwaysAllowedBytes = 64 << 20;
constexpr double kBytesOfMapping = 2000;  ///< memory of HDF5 for a plane of a part, measured: 1600

/// The parts in a folder.
struct FoundParts {
  ForceFileInfo info;  ///< of the first part found
  std::map<std::uint64_t, std::filesystem::path> files;
  JoinedParts joined;
  double bytes = 0;  ///< of their files

  [[nodiscard]] FrameRange frames(std::uint64_t index) const {
    ForcePart part = *info.part;
    part.index = index;
    return frames_of(part);
  }
};

/// Throws Error unless `info` describes a part of the same solve as `first`.
void require_same(const ForceFileInfo& info, const ForceFileInfo& first,
                  const std::filesystem::path& file) {
  ForcePart part = *info.part;
  part.index = first.part->index;
  const bool fits = part == *first.part && info.rows == first.rows && info.cols == first.cols &&
                    info.angles == first.angles && info.uncertainty == first.uncertainty &&
                    info.contacts.has_value() == first.contacts.has_value();
  if (fits) return;
  throw Error(file.string(),
              "differs from the other parts in its source, plan, calibration or number of parts",
              "solve it again, or remove it");
}

void add_part(FoundParts& found, const std::filesystem::path& file, std::uint64_t index,
              const ForceFileReader& reader) {
  const ForceFileInfo& info = reader.info();
  if (!info.part || info.part->index != index) {
    throw Error(file.string(), fmt::format("is not part {}", index), "solve it again");
  }
  if (found.files.empty()) found.info = info;
  require_same(info, found.info, file);
  if (reader.frames() != found.frames(index).frames()) {
    throw Error(file.string(),
                fmt::format("holds {} frames of {}", reader.frames(), found.frames(index).frames()),
                "solve it again");
  }
  found.files[index] = file;
  std::error_code failed;
  const auto bytes = std::filesystem::file_size(file, failed);
  if (!failed) found.bytes += static_cast<double>(bytes);
}

/// Bytes of a value of each plane and of the status.
double bytes_of_pillar(const ForceFileInfo& info) {
  return 1 + 4 * static_cast<double>(planes_of(info).size());
}

/// Throws Error if times and lost parts, with `copy` as NaN, take far more than the parts found.
void require_plausible(const FoundParts& found, const std::string& folder, bool copy) {
  if (found.joined.lost.empty()) return;
  double lost = 0;
  for (const LostPart& part : found.joined.lost) lost += static_cast<double>(part.frames.frames());
  const double pillars = static_cast<double>(found.info.rows) * found.info.cols;
  const double mappings =
      static_cast<double>(found.joined.lost.size() * (planes_of(found.info).size() + 1));
  const double bytes =
      8 * static_cast<double>(found.joined.frames) +
      (copy ? lost * pillars * bytes_of_pillar(found.info) : mappings * kBytesOfMapping);
  if (bytes <= kAlwaysAllowedBytes + kMostBytesPerFoundByte * found.bytes) return;
  throw Error(folder,
              fmt::format("claims {} frames in {} lost parts, {:.3g} times the bytes of the others",
                          lost, found.joined.lost.size(), bytes / found.bytes),
              copy ? "solve more of them, or join without --copy" : "solve more of them");
}

/// The files in a folder with the name of a part, by index.
std::map<std::uint64_t, std::filesystem::path> files_in(const std::filesystem::path& folder) {
  std::map<std::uint64_t, std::filesystem::path> files;
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed)) {
    const std::string stem = entry.path().stem().string();
    if (stem.size() != 5 || !std::ranges::all_of(stem, [](char c) { return c >= '0' && c <= '9'; }))
      continue;
    const std::uint64_t index = std::stoull(stem);
    if (entry.path().filename() == part_file({}, index).filename()) files[index] = entry.path();
  }
  return files;
}

/// Steps of joining `parts`: each is examined, and then opened for times, contacts and planes.
std::uint64_t steps_of(const FoundParts& found, std::uint64_t parts, bool copy) {
  std::uint64_t steps = found.info.contacts ? 3 : 2;
  if (copy) steps += planes_of(found.info).size() + 1;
  return steps * parts;
}

FoundParts find_parts(const std::filesystem::path& output, const JoinOptions& options) {
  const std::filesystem::path folder = part_file(output, 1).parent_path();
  FoundParts found;
  std::map<std::uint64_t, std::string> unreadable;
  const auto files = files_in(folder);
  std::uint64_t examined = 0;
  for (const auto& [index, file] : files) {
    if (options.progress) options.progress(examined++, steps_of(found, files.size(), options.copy));
    std::optional<ForceFileReader> reader;
    try {
      reader.emplace(file, options.read);
    } catch (const Error& error) {
      unreadable[index] = error.what();
      continue;
    }
    add_part(found, file, index, *reader);
  }
  if (found.files.empty()) {
    if (!unreadable.empty()) {
      throw Error(folder.string(),
                  fmt::format("has no usable part: {}", unreadable.begin()->second),
                  "solve it again");
    }
    throw Error(folder.string(), "has no parts", "solve some with 'pillarfield solve --part'");
  }
  const ForcePart& part = *found.info.part;
  found.joined.frames = part.frames;
  found.joined.parts = part.count;
  for (std::uint64_t index = 1; index <= part.count; ++index) {
    if (found.files.contains(index)) continue;
    const std::string file = part_file(output, index).string();
    const auto damaged = unreadable.find(index);
    found.joined.lost.push_back(
        {index, found.frames(index),
         damaged != unreadable.end() ? damaged->second : file + " is absent"});
  }
  const auto& lost = found.joined.lost;
  if (options.allow_lost) require_plausible(found, folder.string(), options.copy);
  if (lost.empty() || options.allow_lost) return found;
  throw Error(folder.string(),
              fmt::format("lacks {} of {} parts: {}{}", lost.size(), part.count,
                          name_of(lost.front()), lost.size() > 1 ? ", ..." : ""),
              "solve them, or join the others with --allow-missing");
}

std::string path_of(const ResultPlane& plane) {
  return fmt::format("/{}/{}", plane.group(), plane.name);
}

/// A joined file while it is written.
class Joined {
 public:
  Joined(const std::filesystem::path& output, const FoundParts& found, const JoinOptions& options)
      : found_(found),
        info_(found.info),
        copy_(options.copy),
        progress_(options.progress),
        done_(found.files.size()),
        output_(output, OutputKind::forces, options.replace),
        file_(hdf5::create(output_)) {
    info_.part.reset();
    write_info(file_, info_, output);
    static_cast<void>(hdf5::create_group(file_, force_format::kForce));
    if (info_.uncertainty) {
      static_cast<void>(hdf5::create_group(file_, force_format::kUncertainty));
    }
    if (!options.copy) {
      ForcePart all = *found.info.part;
      all.index = 1;
      const hdf5::Handle parts = write_part(file_, force_format::kParts, all);
      const std::string folder = part_file(output, 1).parent_path().filename().string();
      hdf5::write_attribute(file_, parts.get(), force_format::kFolder, folder);
    }
  }

  void write() {
    write_times();
    for (const ResultPlane& plane : planes_of(info_)) {
      const std::string name = path_of(plane);
      copy_ ? copy_plane(name.c_str(), H5T_IEEE_F32LE, kNoForce)
            : map_plane(name.c_str(), H5T_IEEE_F32LE, &kNoForce);
    }
    copy_ ? copy_plane(force_format::kStatus, H5T_STD_U8LE, kNoStatus)
          : map_plane(force_format::kStatus, H5T_STD_U8LE, &kNoStatus);
    if (info_.contacts) write_contacts();
    hdf5::close(file_);
    output_.commit();
  }

 private:
  [[nodiscard]] std::vector<double> times_of_parts();
  void write_times();
  void map_plane(const char* name, hid_t stored_type, const void* fill);
  [[nodiscard]] hdf5::StoredFrames open_plane(const hdf5::File& file, const char* name,
                                              const FrameRange& range) const;
  template <class Value>
  void copy_plane(const char* name, hid_t type, Value lost);
  void write_contacts();
  void report() const;
  [[nodiscard]] std::optional<hdf5::File> open(std::uint64_t index);

  const FoundParts& found_;
  ForceFileInfo info_;
  bool copy_;
  StepProgress progress_;
  std::uint64_t done_;  ///< steps
  OutputFile output_;
  hdf5::File file_;
};

void Joined::report() const {
  if (progress_) progress_(done_, steps_of(found_, found_.files.size(), copy_));
}

/// Opens a part for the next step. One at a time is open, since a process may open few files.
std::optional<hdf5::File> Joined::open(std::uint64_t index) {
  const auto found = found_.files.find(index);
  if (found == found_.files.end()) return std::nullopt;
  report();
  ++done_;
  return hdf5::open_to_read(InputFile(found->second));
}

/// The times of the parts found, NaN in lost ones. Checks all planes: the reader of a part opens
/// those that it reads, and takes the frames that they share.
std::vector<double> Joined::times_of_parts() {
  std::vector<double> times(found_.joined.frames, std::numeric_limits<double>::quiet_NaN());
  double before_s = -std::numeric_limits<double>::infinity();
  for (const auto& [index, path] : found_.files) {
    const FrameRange range = found_.frames(index);
    const hdf5::File file = *open(index);
    static_cast<void>(open_plane(file, force_format::kStatus, range));
    for (const ResultPlane& plane : planes_of(info_)) {
      static_cast<void>(open_plane(file, path_of(plane).c_str(), range));
    }
    const std::span part(times.data() + range.first, range.frames());
    hdf5::StoredFrames(file, force_format::kTime, 0)
        .get_all(0, part.size(), H5T_NATIVE_DOUBLE, part.data());
    RisingTimes(path.string(), before_s).add(part);
    if (!part.empty()) before_s = part.back();
  }
  return times;
}

void Joined::write_times() {
  const std::vector<double> times = times_of_parts();
  if (!copy_) return hdf5::write_numbers(file_, force_format::kTime, times);
  hdf5::ExtendibleDataset target(file_, force_format::kTime, H5T_IEEE_F64LE, {});
  target.append(H5T_NATIVE_DOUBLE, times.data(), times.size());
}

void Joined::map_plane(const char* name, hid_t stored_type, const void* fill) {
  std::vector<hdf5::VirtualPart> parts;
  for (std::uint64_t index = 1; index <= found_.joined.parts; ++index) {
    // A lost part may be found again.
    const FrameRange range = found_.frames(index);
    const std::filesystem::path file = part_file(output_.path().filename(), index);
    parts.push_back({file, range.first, range.frames()});
  }
  hdf5::create_virtual_frames(file_, name, stored_type,
                              {found_.joined.frames, info_.rows, info_.cols}, parts, fill);
}

/// What a copy of a part's plane takes from it.
template <class Value>
struct PlaneLayout {
  Value idle = 0;  ///< value in pillars that nothing touches
  hdf5::Tiling tiling = hdf5::Tiling::squares;
};

template <class Value>
PlaneLayout<Value> layout_of(const hdf5::File& file, const char* name, hid_t type, hsize_t cols) {
  const std::string failure = fmt::format("the layout of {} cannot be read", name);
  const hdf5::Handle dataset = hdf5::open_object(file, name);
  const hdf5::Handle layout =
      hdf5::own(H5Dget_create_plist(dataset.get()), file.path, failure, hdf5::kDamaged);
  PlaneLayout<Value> found;
  hdf5::require(H5Pget_fill_value(layout.get(), type, &found.idle), file.path, failure,
                hdf5::kDamaged);
  std::array<hsize_t, 3> chunk{};
  const bool is_chunked = H5Pget_layout(layout.get()) == H5D_CHUNKED &&
                          H5Pget_chunk(layout.get(), 3, chunk.data()) == 3;
  if (is_chunked && chunk[2] == cols) found.tiling = hdf5::Tiling::strips;
  return found;
}

/// A plane of a part; the reader checked only those that it reads.
hdf5::StoredFrames Joined::open_plane(const hdf5::File& file, const char* name,
                                      const FrameRange& range) const {
  hdf5::StoredFrames plane(file, name, 2, true);
  const bool fits = plane.shape() == std::vector<hsize_t>{info_.rows, info_.cols} &&
                    plane.frames() == range.frames();
  if (fits) return plane;
  throw Error(file.path.string(), fmt::format("{} differs in size from its status", name),
              "solve this part again");
}

template <class Value>
void Joined::copy_plane(const char* name, hid_t type, Value lost) {
  const auto layout = layout_of<Value>(hdf5::open_to_read(InputFile(found_.files.begin()->second)),
                                       name, type, info_.cols);
  hdf5::TiledFrames target(file_, name, type, info_.rows, info_.cols, &layout.idle, layout.tiling,
                           found_.joined.frames);
  std::vector<Value> values(std::size_t{info_.rows} * info_.cols);
  for (std::uint64_t index = 1; index <= found_.joined.parts; ++index) {
    const FrameRange range = found_.frames(index);
    const std::optional<hdf5::File> file = open(index);
    std::optional<hdf5::StoredFrames> source;
    if (file) source = open_plane(*file, name, range);
    if (!source) std::ranges::fill(values, lost);
    for (std::uint64_t frame = range.first; frame < range.end; ++frame) {
      report();
      if (source) source->get(frame - range.first, type, values.data());
      target.append(values.data());
    }
  }
  target.flush();
}

/// A part whose table is longer than its frames would shift those of the next parts.
void require_frames(const ContactTables& tables, std::uint64_t frames,
                    const std::filesystem::path& file) {
  if (tables.frames() == frames) return;
  throw Error(file.string(), "its table of contacts does not fit its frames",
              "solve this part again");
}

void Joined::write_contacts() {
  ContactTables tables(file_, *info_.contacts);
  for (std::uint64_t index = 1; index <= found_.joined.parts; ++index) {
    const FrameRange range = found_.frames(index);
    if (const std::optional<hdf5::File> file = open(index)) {
      tables.append(*file, range.first);
      require_frames(tables, range.end, file->path);
    } else {
      tables.append_lost(range.frames());
    }
  }
  tables.write();
}

}  // namespace

JoinedParts join_parts(const std::filesystem::path& output, const JoinOptions& options) {
  const hdf5::QuietErrors quiet;
  const std::string extension = extension_of(output);
  if (extension != ".h5" && extension != ".hdf5") {
    throw Error(output.string(), "a joined file is an HDF5 file", "end its name in .h5");
  }
  const FoundParts found = find_parts(output, options);
  Joined(output, found, options).write();
  return found.joined;
}

}  // namespace pillarfield
