#include "io/force_sink.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "io/file_kind.h"
#include "io/force_planes.h"
#include "pillarfield/contact_file.h"
#include "pillarfield/error.h"
#include "pillarfield/skin.h"

namespace pillarfield {

// Each is defined beside its sink.
SinkFormat force_hdf5_format();
SinkFormat force_csv_format();
SinkFormat force_npy_format();
SinkFormat contact_csv_format();
SinkFormat contact_json_format();

namespace {

/// All formats, in the order in which messages list their extensions.
std::span<const SinkFormat> sink_formats() {
  static const std::array formats = {force_hdf5_format(), force_csv_format(), force_npy_format(),
                                     contact_csv_format(), contact_json_format()};
  return formats;
}

const SinkFormat& format_of(const std::filesystem::path& path, OutputKind kind) {
  if (const SinkFormat* const format = format_by_extension(path, kind)) return *format;
  throw Error(path.string(),
              kind == OutputKind::forces ? "its extension is not that of a force file"
                                         : "its extension is not that of a table of contacts",
              "use " + endings_of(kind));
}

void check_time(const SolvedFrame& frame, const std::string& where) {
  if (std::isfinite(frame.time_s)) return;
  throw Error(where, fmt::format("its time is {}", frame.time_s), "give seconds");
}

void check(const ForceFileInfo& info, const std::string& where) {
  const std::uint32_t most = most_elements(info.layout);
  const auto in_range = [&](std::uint32_t size) { return size >= 1 && size <= most; };
  if (!in_range(info.rows) || !in_range(info.cols)) {
    throw Error(where,
                fmt::format("a field of {} x {} {}", info.rows, info.cols, name_of(info.layout)),
                fmt::format("rows and columns must lie in [1, {}]", most));
  }
  if (!info.element_pitch_mm.is_positive()) {
    throw Error(where, fmt::format("element_pitch_mm is {}", text_of(info.element_pitch_mm)),
                "it must be above zero");
  }
}

}  // namespace

void check(const SolvedFrame& frame, const ForceFileInfo& info, const std::string& where) {
  const ForceFieldView& forces = frame.forces;
  const std::size_t elements = std::size_t{info.rows} * info.cols;
  const auto complete = [&](std::span<const float> plane) { return plane.size() == elements; };
  if (forces.rows != info.rows || forces.cols != info.cols || !complete(forces.normal) ||
      forces.status.size() != elements) {
    throw Error(
        where, fmt::format("a frame of {} x {} {}", forces.rows, forces.cols, name_of(info.layout)),
        fmt::format("the file needs frames of {} x {}", info.rows, info.cols));
  }
  for (const ResultPlane& plane : std::span(kResultPlanes).first(kSolvedPlanes)) {
    if (!has_plane(info.layout, info.angles, info.uncertainty, plane)) continue;
    if (complete(plane_of(forces, plane.index))) continue;
    throw Error(where, fmt::format("a frame without {}", plane.field()),
                "solve with all outputs that the file needs");
  }
  check_time(frame, where);
  if (info.contacts) static_cast<void>(contacts_of(frame, where));
}

const FrameContacts& contacts_of(const SolvedFrame& frame, const std::string& where) {
  check_time(frame, where);
  if (frame.contacts != nullptr) return *frame.contacts;
  throw Error(where, "a frame without its contacts", "track them, or write forces alone");
}

const SinkFormat* format_by_extension(const std::filesystem::path& path, OutputKind kind) {
  const std::string extension = extension_of(path);
  for (const SinkFormat& format : sink_formats()) {
    const auto& extensions = format.extensions;
    const bool has_extension =
        std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
    if (format.kind == kind && !extension.empty() && has_extension) return &format;
  }
  return nullptr;
}

const SinkFormat* format_by_beginning(std::string_view head) {
  for (const SinkFormat& format : sink_formats()) {
    const bool holds = head.find(format.holds) != std::string_view::npos;
    if (!format.begins.empty() && head.starts_with(format.begins) && holds) return &format;
  }
  return nullptr;
}

std::string endings_of(OutputKind kind) {
  std::vector<std::string_view> extensions;
  for (const SinkFormat& format : sink_formats()) {
    for (const std::string_view extension : format.extensions) {
      if (format.kind == kind && !extension.empty()) extensions.push_back(extension);
    }
  }
  if (extensions.empty()) return "";
  const std::string_view last = extensions.back();
  extensions.pop_back();
  return fmt::format("{} or {}", fmt::join(extensions, ", "), last);
}

PlannedOutput planned_force_file(const std::filesystem::path& path) {
  return {path, format_of(path, OutputKind::forces).kind};
}

PlannedOutput planned_contact_file(const std::filesystem::path& path) {
  return {path, format_of(path, OutputKind::contacts).kind};
}

ForceFileInfo file_info(const SolverPlan& plan, const std::string& device,
                        const std::string& source) {
  ForceFileInfo info;
  info.rows = plan.skin.element_rows();
  info.cols = plan.skin.element_cols();
  info.element_pitch_mm = plan.skin.element_pitch_mm();
  info.estimator = name_of(estimator_of(plan));
  if (plan.skin.has_pillars() && plan.estimator != Estimator::paper)
    info.segment_point = plan.segment_point;
  info.device = device;
  info.source = source;
  info.angles = plan.angles;
  info.uncertainty = plan.uncertainty;
  info.pressure = plan.pressure;
  info.effects = plan.calibration.effects;
  info.surface = plan.skin.surface;
  info.layout = plan.skin.layout;
  return info;
}

std::unique_ptr<ForceSink> create_force_sink(const std::filesystem::path& path,
                                             const ForceFileInfo& info, Replace replace) {
  check(info, path.string());
  const SinkFormat& format = format_of(path, OutputKind::forces);
  if (info.contacts && !format.begins.empty()) {
    throw Error(path.string(), "only HDF5 files can hold contacts beside forces",
                "use .h5, or write the contacts to a separate file");
  }
  return format.create(path, info, replace);
}

std::unique_ptr<ForceSink> create_contact_sink(const std::filesystem::path& path,
                                               const ContactFileInfo& info, Replace replace) {
  ForceFileInfo forces;
  forces.element_pitch_mm = info.element_pitch_mm;
  forces.source = info.source;
  forces.contacts = info.options;
  forces.layout = info.layout;
  forces.pressure_unit = info.pressure_unit;
  return format_of(path, OutputKind::contacts).create(path, forces, replace);
}

}  // namespace pillarfield
