#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/number_text.h"
#include "io/force_format.h"
#include "io/force_planes.h"
#include "io/hdf5/attribute.h"
#include "io/hdf5/crash_guard.h"
#include "io/hdf5/file.h"
#include "io/hdf5/force_info.h"
#include "io/hdf5/handle.h"
#include "io/hdf5/readers.h"
#include "io/hdf5/stored_frames.h"
#include "io/stored_skin.h"
#include "pillarfield/contact_columns.h"
#include "pillarfield/contact_tracker.h"
#include "pillarfield/error.h"
#include "pillarfield/force_file.h"
#include "pillarfield/skin.h"

namespace pillarfield {
namespace {

/// Reads the group /contacts of a force file.
class ContactTablesReader {
 public:
  /// Throws Error if a table lacks a column or options are out of range.
  ContactTablesReader(const hdf5::File& file, SkinLayout layout);

  [[nodiscard]] std::uint64_t frames() const { return frames_; }
  [[nodiscard]] const ContactOptions& options() const { return options_; }

  /// Reads frame `index` < frames(), without its time. Throws Error if the tables contradict each
  /// other or the frame claims more than a million contacts.
  [[nodiscard]] FrameContacts read(std::uint64_t index) const;

 private:
  /// The datasets of a group in the order of its columns, and their common number of rows.
  struct Table {
    std::vector<std::optional<hdf5::StoredFrames>> columns;  ///< unset: absent
    std::uint64_t rows = 0;

    void open(const hdf5::File& file, const std::string& group, const char* name,
              bool optional = false);
  };

  void read_options(const hdf5::File& file);
  void open_tables(const hdf5::File& file);
  void drop_frames_without_rows();
  [[nodiscard]] bool has_rows_of(std::uint64_t index) const;
  [[nodiscard]] std::uint64_t count_at(std::size_t column, std::uint64_t index) const;
  void require_rows(const Table& table, std::uint64_t first, std::uint64_t count) const;

  std::filesystem::path path_;
  ContactOptions options_;
  QuantityColumns columns_;
  Table contacts_;
  Table patch_;  ///< the columns of kPatchRows first
  Table ended_;
  std::uint64_t frames_ = 0;
};

/// Limit per frame, so that a damaged file causes an allocation of at most a few hundred megabytes.
constexpr std::uint64_t kMaxContacts = 1'000'000;

/// Indices into kPatchRows.
enum PatchRow : std::uint8_t { kFirstContact, kContactCount, kFirstEnded, kEndedCount };

/// Sets all columns of `rows`; `part` returns the member of a row that holds the columns.
template <class Row, class Item, class Part>
void read_columns(std::span<const ContactColumn<Row>> columns,
                  const std::optional<hdf5::StoredFrames>* datasets, std::uint64_t first,
                  std::vector<Item>& rows, Part part) {
  std::vector<double> values(rows.size());
  for (const auto& column : columns) {
    const auto& dataset = *datasets++;
    if (!dataset) continue;
    dataset->get_all(first, values.size(), H5T_NATIVE_DOUBLE, values.data());
    for (std::size_t i = 0; i < rows.size(); ++i) column.set(part(rows[i]), values[i]);
  }
}

void ContactTablesReader::Table::open(const hdf5::File& file, const std::string& group,
                                      const char* name, bool optional) {
  const std::string path = group + "/" + name;
  columns.emplace_back();
  if (optional && !hdf5::exists(file, path)) return;
  columns.back().emplace(file, path, 0);
  const std::uint64_t frames = columns.back()->frames();
  rows = columns.size() == 1 ? frames : std::min(rows, frames);
}

ContactTablesReader::ContactTablesReader(const hdf5::File& file, SkinLayout layout)
    : path_(file.path) {
  options_.layout = layout;
  read_options(file);
  columns_ = quantity_columns(true, options_.layout);
  open_tables(file);
  if (file.unclosed) drop_frames_without_rows();
}

void ContactTablesReader::open_tables(const hdf5::File& file) {
  for (const auto& column : identity_columns())
    contacts_.open(file, force_format::kContacts, column.name);
  for (const auto& column : columns_)
    contacts_.open(file, force_format::kContacts, column.name, column.optional);
  for (const char* name : force_format::kPatchRows) patch_.open(file, force_format::kPatch, name);
  for (const auto& column : columns_)
    patch_.open(file, force_format::kPatch, column.name, column.optional);
  for (const auto& column : ended_columns()) ended_.open(file, force_format::kEnded, column.name);
  frames_ = patch_.rows;
}

/// Drops the last frames if they refer to absent rows, which a killed writer leaves. Rows are in
/// the order of frames.
void ContactTablesReader::drop_frames_without_rows() {
  std::uint64_t good = 0;
  for (std::uint64_t beyond = frames_ + 1; beyond - good > 1;) {
    const std::uint64_t middle = good + (beyond - good) / 2;
    (has_rows_of(middle - 1) ? good : beyond) = middle;
  }
  frames_ = good;
}

bool ContactTablesReader::has_rows_of(std::uint64_t index) const {
  return count_at(kFirstContact, index) + count_at(kContactCount, index) <= contacts_.rows &&
         count_at(kFirstEnded, index) + count_at(kEndedCount, index) <= ended_.rows;
}

void ContactTablesReader::read_options(const hdf5::File& file) {
  const hdf5::Handle group = hdf5::open_object(file, force_format::kContacts);
  const hdf5::Attributes attributes(file, group.get());
  const auto minimum = attributes.number(force_format::kMinimumPillars);
  constexpr double kMaxExact = 0x1p53;
  if (minimum && *minimum >= 0 && *minimum <= kMaxExact) {
    options_.minimum_pillars = static_cast<std::uint64_t>(*minimum);
  }
  options_.friction.given = attributes.number(force_format::kGivenFriction);
  options_.reach_mm = attributes.number(force_format::kReach).value_or(options_.reach_mm);
  check(options_, file.path.string());
}

std::uint64_t ContactTablesReader::count_at(std::size_t column, std::uint64_t index) const {
  std::uint64_t count = 0;
  patch_.columns[column]->get(index, H5T_NATIVE_UINT64, &count);
  // Clamped, so that the sum of two does not wrap.
  return std::min<std::uint64_t>(count, INT64_MAX);
}

void ContactTablesReader::require_rows(const Table& table, std::uint64_t first,
                                       std::uint64_t count) const {
  if (first + count <= table.rows) return;
  throw Error(path_.string(),
              fmt::format("has {} rows in {}, but a frame refers to row {}", table.rows,
                          table.columns.front()->name(), first + count - 1),
              hdf5::kDamaged);
}

FrameContacts ContactTablesReader::read(std::uint64_t index) const {
  const std::uint64_t first_contact = count_at(kFirstContact, index);
  const std::uint64_t contacts = count_at(kContactCount, index);
  const std::uint64_t first_ended = count_at(kFirstEnded, index);
  const std::uint64_t ended = count_at(kEndedCount, index);
  require_rows(contacts_, first_contact, contacts);
  require_rows(ended_, first_ended, ended);
  if (std::max(contacts, ended) > kMaxContacts) {
    throw Error(
        path_.string(),
        fmt::format("frame {} claims to have {} contacts", index, std::max(contacts, ended)),
        hdf5::kDamaged);
  }

  FrameContacts frame;
  frame.contacts.resize(contacts);
  frame.ended.resize(ended);
  const auto itself = [](auto& row) -> auto& { return row; };
  const auto quantities = [](TrackedContact& contact) -> ContactQuantities& {
    return contact.quantities;
  };
  const std::optional<hdf5::StoredFrames>* const contact_columns = contacts_.columns.data();
  read_columns(identity_columns(), contact_columns, first_contact, frame.contacts, itself);
  read_columns(columns_, contact_columns + identity_columns().size(), first_contact, frame.contacts,
               quantities);
  read_columns(ended_columns(), ended_.columns.data(), first_ended, frame.ended, itself);
  std::vector<ContactQuantities> patch(1);
  read_columns(columns_, patch_.columns.data() + std::size(force_format::kPatchRows), index, patch,
               itself);
  frame.total = patch[0];
  frame.total.has_shear = options_.layout == SkinLayout::pillars;
  for (TrackedContact& contact : frame.contacts) {
    contact.quantities.has_shear = frame.total.has_shear;
  }
  return frame;
}

}  // namespace

namespace {

struct OpenForces {
  explicit OpenForces(hdf5::File opened);

  void open_planes(bool may_lack_chunks);
  void read_size(const std::vector<hsize_t>& shape);
  void count_frames();
  void require_frame(std::uint64_t index) const;

  hdf5::File file;
  std::vector<hdf5::StoredFrames> planes;  // shear_x, shear_y, normal, then uncertainty if present
  hdf5::StoredFrames status;
  hdf5::StoredFrames time;
  std::optional<ContactTablesReader> contacts;
  ForceFileInfo info;
  std::uint64_t frames = 0;
  std::vector<std::string> warnings;
};

/// Angles, interval ends and pressure are not read, since they follow from the other planes.
bool is_read(const ResultPlane& plane) {
  return plane.set == PlaneSet::forces || plane.set == PlaneSet::uncertainty;
}

std::vector<float>* force_plane(ForceField& forces, std::size_t index) {
  return std::array{&forces.shear_x, &forces.shear_y, &forces.normal}.at(index);
}

void require_class(const hdf5::StoredFrames& frames, H5T_class_t kind, const char* kind_name,
                   const std::filesystem::path& path) {
  if (frames.value_class() == kind) return;
  throw Error(path.string(),
              fmt::format("{} must hold {}, not {}", frames.name(), kind_name,
                          hdf5::name_of_type(frames.type())),
              "see docs/formats.md");
}

OpenForces::OpenForces(hdf5::File opened) : file(std::move(opened)) {
  const std::filesystem::path& path = file.path;
  const int version = hdf5::require_format(file, force_format::kName, force_format::kVersion);
  read_planes_of(file, info);
  open_planes(version >= force_format::kSparseSince);
  time = {file, force_format::kTime, 0};
  require_class(time, H5T_FLOAT, "floats", path);
  if (hdf5::exists(file, force_format::kContacts)) {
    contacts.emplace(file, info.layout);
    info.contacts = contacts->options();
  }
  read_size(status.shape());
  read_info(file, info, warnings);
  count_frames();
}

void OpenForces::open_planes(bool may_lack_chunks) {
  for (const ResultPlane& plane : planes_of(info)) {
    if (!is_read(plane)) continue;
    planes.emplace_back(file, fmt::format("/{}/{}", plane.group(), plane.name), 2, may_lack_chunks);
    require_class(planes.back(), H5T_FLOAT, "floats", file.path);
  }
  status = {file, force_format::kStatus, 2, may_lack_chunks};
  require_class(status, H5T_INTEGER, "integers", file.path);
}

void OpenForces::read_size(const std::vector<hsize_t>& shape) {
  for (const hsize_t size : shape) {
    if (size >= 1 && size <= most_elements(info.layout)) continue;
    throw Error(file.path.string(), fmt::format("its fields are {} x {}", shape[0], shape[1]),
                fmt::format("rows and columns must lie in [1, {}]", most_elements(info.layout)));
  }
  for (const auto& plane : planes) {
    if (plane.shape() == shape) continue;
    throw Error(file.path.string(),
                fmt::format("{} and {} differ in size", plane.name(), status.name()),
                "the file is damaged; solve the recording again");
  }
  info.rows = static_cast<std::uint32_t>(shape[0]);
  info.cols = static_cast<std::uint32_t>(shape[1]);
}

void OpenForces::count_frames() {
  frames = std::min({time.frames(), status.frames(), file.readable_frames});
  for (const auto& plane : planes) frames = std::min(frames, plane.frames());
  if (contacts) frames = std::min(frames, contacts->frames());
  if (file.unclosed) {
    warnings.push_back(fmt::format(
        "The file was not closed: its writer was killed or is still running. The {} flushed frames "
        "are read.",
        frames));
  }
}

void OpenForces::require_frame(std::uint64_t index) const {
  if (index < frames) return;
  throw Error(file.path.string(), fmt::format("has no frame {}", index),
              fmt::format("it holds {}, counted from 0", counted(frames, "frame")));
}

}  // namespace

struct ForceFileReader::State : OpenForces {
  using OpenForces::OpenForces;
};

ForceFileReader::ForceFileReader(const std::filesystem::path& path, const ReadOptions& options) {
  const hdf5::QuietErrors quiet;
  const hdf5::CrashGuard guard(path, options.trust, hdf5::CrashGuard::kNoLimit);
  state_ = std::make_unique<State>(hdf5::open_to_read(InputFile(path), options.trust));
}

ForceFileReader::~ForceFileReader() = default;
ForceFileReader::ForceFileReader(ForceFileReader&&) noexcept = default;
ForceFileReader& ForceFileReader::operator=(ForceFileReader&&) noexcept = default;

const ForceFileInfo& ForceFileReader::info() const { return state_->info; }
std::uint64_t ForceFileReader::frames() const { return state_->frames; }
const std::vector<std::string>& ForceFileReader::warnings() const { return state_->warnings; }

double ForceFileReader::read(std::uint64_t index, ForceField& forces) const {
  const hdf5::QuietErrors quiet;
  state_->require_frame(index);
  double time_s = 0;
  state_->time.get(index, H5T_NATIVE_DOUBLE, &time_s);
  if (forces.rows != state_->info.rows || forces.cols != state_->info.cols) {
    forces = ForceField(state_->info.rows, state_->info.cols);
  }
  for (auto* plane : {&forces.shear_x, &forces.shear_y, &forces.normal}) plane->clear();
  for (auto& plane : forces.uncertainty) plane.clear();
  auto stored = state_->planes.begin();
  for (const ResultPlane& plane : planes_of(state_->info)) {
    if (!is_read(plane)) continue;
    auto& values = plane.set == PlaneSet::uncertainty
                       ? forces.uncertainty[static_cast<Uncertainty>(plane.index - kNamedPlanes)]
                       : *force_plane(forces, plane.index);
    values.resize(forces.elements());
    stored++->get(index, H5T_NATIVE_FLOAT, values.data());
  }
  forces.status.resize(forces.elements());
  state_->status.get(index, H5T_NATIVE_UINT8, forces.status.data());
  return time_s;
}

FrameContacts ForceFileReader::read_contacts(std::uint64_t index) const {
  const hdf5::QuietErrors quiet;
  state_->require_frame(index);
  if (!state_->contacts) {
    throw Error(state_->file.path.string(), "holds no contacts", "solve with --contacts");
  }
  FrameContacts contacts = state_->contacts->read(index);
  state_->time.get(index, H5T_NATIVE_DOUBLE, &contacts.time_s);
  return contacts;
}

bool is_force_file(const std::filesystem::path& path) {
  return hdf5::format_of(path) == force_format::kName;
}

}  // namespace pillarfield
