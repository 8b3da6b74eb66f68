#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/force_format.h"
#include "io/force_planes.h"
#include "io/hdf5/attribute.h"
#include "io/hdf5/contact_hdf5_reader.h"
#include "io/hdf5/file.h"
#include "io/hdf5/force_info.h"
#include "io/hdf5/handle.h"
#include "io/hdf5/readers.h"
#include "io/hdf5/stored_frames.h"
#include "io/stored_skin.h"
#include "pillarfield/error.h"
#include "pillarfield/force_file.h"
#include "pillarfield/skin.h"

namespace pillarfield {

namespace {

struct OpenForces {
  explicit OpenForces(hdf5::File opened);

  void open_planes(bool may_lack_chunks);
  void read_size(const std::vector<hsize_t>& shape);
  void read_info();
  [[nodiscard]] SkinLayout read_layout() const;
  void read_surface_of_skin();
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
  info.layout = read_layout();
  info.angles = hdf5::exists(file, force_format::kMagnitude);
  info.uncertainty = hdf5::exists(file, force_format::kUncertainty);
  info.pressure = hdf5::exists(file, force_format::kPressure);
  open_planes(version >= force_format::kSparseSince);
  time = {file, force_format::kTime, 0};
  require_class(time, H5T_FLOAT, "floats", path);
  if (hdf5::exists(file, force_format::kContacts)) {
    contacts.emplace(file, info.layout);
    info.contacts = contacts->options();
  }
  read_size(status.shape());
  read_info();
  read_surface_of_skin();
  info.part = read_part(file);
  count_frames();
}

SkinLayout OpenForces::read_layout() const {
  const auto name = hdf5::read_text(file, file.id.get(), force_format::kLayout);
  if (!name) return SkinLayout::pillars;
  if (const auto layout = layout_named(*name)) return *layout;
  throw Error(file.path.string(), fmt::format("its layout is '{:.40}'", *name),
              "it must be pillars or sensels");
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
  hdf5::require_probe_limit(file, force_format::kStatus,
                            static_cast<double>(info.rows) * static_cast<double>(info.cols));
}

void OpenForces::read_info() {
  const hid_t root = file.id.get();
  info.estimator = hdf5::read_text(file, root, force_format::kEstimator).value_or("");
  info.segment_point = hdf5::read_number(file, root, force_format::kSegmentPoint);
  info.effects = read_effects(file, force_format::kEffects);
  check(info.effects, file.path.string());
  info.device = hdf5::read_text(file, root, force_format::kDevice).value_or("");
  info.source = hdf5::read_text(file, root, force_format::kSource).value_or("");
  const char* const pitch = force_format::pitch_of(info.layout);
  const auto pitch_mm = hdf5::read_number(file, root, pitch);
  if (!pitch_mm) {
    Skin usual;
    usual.layout = info.layout;
    info.element_pitch_mm = usual.element_pitch_mm();
    warnings.push_back(
        fmt::format("The file has no {}; {:.6g} mm is assumed.", pitch, info.element_pitch_mm));
    return;
  }
  if (!std::isfinite(*pitch_mm) || *pitch_mm <= 0) {
    throw Error(file.path.string(), fmt::format("{} is {}", pitch, *pitch_mm),
                "it must be above zero");
  }
  info.element_pitch_mm = *pitch_mm;
}

void OpenForces::read_surface_of_skin() {
  info.surface = read_surface(file, {info.rows, info.cols, info.element_pitch_mm});
  if (info.contacts) info.contacts->surface = info.surface;
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
              fmt::format("it holds {} frames, counted from 0", frames));
}

}  // namespace

struct ForceFileReader::State : OpenForces {
  using OpenForces::OpenForces;
};

void try_forces(hdf5::File file) { (void)OpenForces(std::move(file)); }

ForceFileReader::ForceFileReader(const std::filesystem::path& path, const ReadOptions& options) {
  const hdf5::QuietErrors quiet;
  state_ = std::make_unique<State>(open_probed(path, options));
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

bool is_force_file(const std::filesystem::path& path, const ReadOptions& options) {
  const hdf5::QuietErrors quiet;
  try {
    const hdf5::File file = open_probed(path, options);
    return hdf5::read_text(file, file.id.get(), "format") == force_format::kName;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace pillarfield
