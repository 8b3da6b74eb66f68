#include <fmt/format.h>

#include <array>
#include <limits>
#include <span>
#include <string>

#include "io/file_kind.h"
#include "io/file_source.h"
#include "io/force_format.h"
#include "io/force_planes.h"
#include "io/hdf5/contact_hdf5_tables.h"
#include "io/hdf5/file.h"
#include "io/hdf5/force_info.h"
#include "io/hdf5/frames.h"
#include "io/hdf5/stored_frames.h"
#include "io/hdf5/tiled_frames.h"
#include "pillarfield/error.h"
#include "pillarfield/force_file.h"

namespace pillarfield {
namespace {

/// The parts in a folder.
struct FoundParts {
  ForceFileInfo info;                        ///< of the first part
  std::vector<std::filesystem::path> files;  ///< by index, from 1

  [[nodiscard]] FrameRange frames(std::uint64_t index) const {
    ForcePart part = *info.part;
    part.index = index;
    return frames_of(part);
  }
};

/// Throws Error unless `reader` holds all frames of part `index` of the same solve as the first.
void require_part(const FoundParts& found, std::uint64_t index, const ForceFileReader& reader) {
  const std::string file = found.files[index - 1].string();
  const ForceFileInfo& info = reader.info();
  const ForceFileInfo& first = found.info;
  if (!info.part || info.part->index != index) {
    throw Error(file, fmt::format("is not part {}", index), "solve it again");
  }
  ForcePart part = *info.part;
  part.index = first.part->index;
  const bool fits = part == *first.part && info.rows == first.rows && info.cols == first.cols &&
                    info.angles == first.angles && info.uncertainty == first.uncertainty &&
                    info.pressure == first.pressure &&
                    info.contacts.has_value() == first.contacts.has_value();
  if (!fits) {
    throw Error(file,
                "differs from the other parts in its source, plan, calibration or number of parts",
                "solve it again, or remove it");
  }
  const std::uint64_t frames = found.frames(index).frames();
  if (reader.frames() == frames) return;
  throw Error(file, fmt::format("holds {} frames of {}", reader.frames(), frames),
              "solve it again");
}

/// Throws Error if the folder lacks parts.
void require_all(const FoundParts& found, const std::filesystem::path& folder) {
  std::string absent;
  std::uint64_t count = 0;
  for (const std::filesystem::path& file : found.files) {
    if (std::filesystem::exists(file)) continue;
    constexpr std::uint64_t kMostNamed = 10;
    if (++count <= kMostNamed) absent += (count > 1 ? ", " : "") + file.filename().string();
    if (count == kMostNamed + 1) absent += ", ...";
  }
  if (count == 0) return;
  throw Error(folder.string(),
              fmt::format("lacks {} of {} parts: {}", count, found.files.size(), absent),
              "solve them with --part K/N");
}

/// Steps of joining: each part is examined, and then opened for times, planes and contacts.
std::uint64_t steps_of(const FoundParts& found) {
  const std::uint64_t steps = planes_of(found.info).size() + (found.info.contacts ? 4 : 3);
  return steps * found.files.size();
}

FoundParts find_parts(const std::filesystem::path& output, const JoinOptions& options) {
  const std::filesystem::path first = part_file(output, 1);
  if (!std::filesystem::exists(first)) {
    throw Error(first.string(), "does not exist", "solve it with 'pillarfield solve --part 1/N'");
  }
  FoundParts found;
  {
    const ForceFileReader reader(first, options.read);
    found.info = reader.info();
  }
  if (!found.info.part) throw Error(first.string(), "is not part 1", "solve it again");
  for (std::uint64_t index = 1; index <= found.info.part->count; ++index) {
    found.files.push_back(part_file(output, index));
  }
  require_all(found, first.parent_path());
  for (std::uint64_t index = 1; index <= found.files.size(); ++index) {
    if (options.progress) options.progress(index - 1, steps_of(found));
    require_part(found, index, ForceFileReader(found.files[index - 1], options.read));
  }
  return found;
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
  }

  void write() {
    write_times();
    for (const ResultPlane& plane : planes_of(info_)) {
      copy_plane<float>(path_of(plane).c_str(), H5T_IEEE_F32LE);
    }
    write_pressure_unit(file_, info_);
    copy_plane<std::uint8_t>(force_format::kStatus, H5T_STD_U8LE);
    if (info_.contacts) write_contacts();
    hdf5::close(file_);
    output_.commit();
  }

 private:
  [[nodiscard]] std::vector<double> times_of_parts();
  void write_times();
  [[nodiscard]] hdf5::StoredFrames open_plane(const hdf5::File& file, const char* name,
                                              const FrameRange& range) const;
  template <class Value>
  void copy_plane(const char* name, hid_t type);
  void write_contacts();
  void report() const;
  [[nodiscard]] hdf5::File open(std::uint64_t index);

  const FoundParts& found_;
  ForceFileInfo info_;
  StepProgress progress_;
  std::uint64_t done_;  ///< steps
  OutputFile output_;
  hdf5::File file_;
};

void Joined::report() const {
  if (progress_) progress_(done_, steps_of(found_));
}

/// Opens a part for the next step. One at a time is open, since a process may open few files.
hdf5::File Joined::open(std::uint64_t index) {
  report();
  ++done_;
  return hdf5::open_to_read(InputFile(found_.files[index - 1]));
}

/// The times of all frames. Checks all planes: the reader of a part opens
/// those that it reads, and takes the frames that they share.
std::vector<double> Joined::times_of_parts() {
  std::vector<double> times(found_.info.part->frames);
  double before_s = -std::numeric_limits<double>::infinity();
  for (std::uint64_t index = 1; index <= found_.files.size(); ++index) {
    const FrameRange range = found_.frames(index);
    const hdf5::File file = open(index);
    static_cast<void>(open_plane(file, force_format::kStatus, range));
    for (const ResultPlane& plane : planes_of(info_)) {
      static_cast<void>(open_plane(file, path_of(plane).c_str(), range));
    }
    const std::span part(times.data() + range.first, range.frames());
    hdf5::StoredFrames(file, force_format::kTime, 0)
        .get_all(0, part.size(), H5T_NATIVE_DOUBLE, part.data());
    TimeOrder(file.path.string()).add(part);
    if (part.empty()) continue;
    if (part.back() <= before_s) {
      throw Error(file.path.string(),
                  fmt::format("ends at {} s, and the part before it at {} s", part.back(), before_s),
                  "solve the part again");
    }
    before_s = part.back();
  }
  return times;
}

void Joined::write_times() {
  const std::vector<double> times = times_of_parts();
  hdf5::ExtendibleDataset target(file_, force_format::kTime, H5T_IEEE_F64LE, {});
  target.append(H5T_NATIVE_DOUBLE, times.data(), times.size());
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
void Joined::copy_plane(const char* name, hid_t type) {
  const auto layout =
      layout_of<Value>(hdf5::open_to_read(InputFile(found_.files.front())), name, type, info_.cols);
  hdf5::TiledFrames target(file_, name, type, info_.rows, info_.cols, &layout.idle, layout.tiling,
                           found_.info.part->frames);
  std::vector<Value> values(std::size_t{info_.rows} * info_.cols);
  for (std::uint64_t index = 1; index <= found_.files.size(); ++index) {
    const FrameRange range = found_.frames(index);
    const hdf5::File file = open(index);
    hdf5::StoredFrames source = open_plane(file, name, range);
    for (std::uint64_t frame = 0; frame < range.frames(); ++frame) {
      report();
      source.get(frame, type, values.data());
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
  for (std::uint64_t index = 1; index <= found_.files.size(); ++index) {
    const FrameRange range = found_.frames(index);
    const hdf5::File file = open(index);
    tables.append(file, range.first);
    require_frames(tables, range.end, file.path);
  }
  tables.write();
}

}  // namespace

ForcePart join_parts(const std::filesystem::path& output, const JoinOptions& options) {
  const hdf5::QuietErrors quiet;
  const std::string extension = extension_of(output);
  if (extension != ".h5" && extension != ".hdf5") {
    throw Error(output.string(), "a joined file is an HDF5 file", "end its name in .h5");
  }
  const FoundParts found = find_parts(output, options);
  Joined(output, found, options).write();
  return *found.info.part;
}

}  // namespace pillarfield
