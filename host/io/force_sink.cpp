#include "io/force_sink.h"

#include <fmt/format.h>

#include <cmath>

#include "io/ending.h"
#include "io/force_planes.h"
#include "pillarfield/error.h"
#include "pillarfield/skin.h"

namespace pillarfield {
namespace {

void check(const ForceFileInfo& info, const std::string& where) {
  const auto in_range = [](std::uint32_t size) { return size >= 1 && size <= kMaxSensels / 2; };
  if (!in_range(info.rows) || !in_range(info.cols)) {
    throw Error(where, fmt::format("a field of {} x {} pillars", info.rows, info.cols),
                fmt::format("rows and columns must lie in [1, {}]", kMaxSensels / 2));
  }
  if (!std::isfinite(info.pillar_pitch_mm) || info.pillar_pitch_mm <= 0) {
    throw Error(where, fmt::format("pillar_pitch_mm is {}", info.pillar_pitch_mm),
                "it must be above zero");
  }
}

}  // namespace

void check(const ForceFieldView& forces, double time_s, const ForceFileInfo& info,
           const std::string& where) {
  const std::size_t pillars = std::size_t{info.rows} * info.cols;
  const auto complete = [&](std::span<const float> plane) { return plane.size() == pillars; };
  if (forces.rows != info.rows || forces.cols != info.cols || !complete(forces.shear_x) ||
      !complete(forces.shear_y) || !complete(forces.normal) || forces.status.size() != pillars) {
    throw Error(where, fmt::format("a frame of {} x {} pillars", forces.rows, forces.cols),
                fmt::format("the file takes whole frames of {} x {}", info.rows, info.cols));
  }
  for (const ResultPlane& plane : planes_of(info)) {
    if (plane.index >= kSolvedPlanes || complete(plane_of(forces, plane.index))) continue;
    throw Error(where, fmt::format("a frame without {}", plane.field()),
                "solve with all outputs that the file shall have");
  }
  if (!std::isfinite(time_s))
    throw Error(where, fmt::format("its time is {}", time_s), "give seconds");
}

void ForceSink::append_contacts(const FrameContacts& /*contacts*/) {
  throw Error("", "a file of forces alone was given contacts", "name them in its ForceFileInfo");
}

OutputKind kind_of_force_file(const std::filesystem::path& path) {
  const std::string ending = ending_of(path);
  if (ending == ".h5" || ending == ".hdf5") return OutputKind::forces;
  if (ending == ".csv") return OutputKind::force_table;
  if (ending == ".npy") return OutputKind::force_array;
  throw Error(path.string(), "its ending is not that of a force file",
              "end it in .h5, .hdf5, .csv or .npy");
}

std::unique_ptr<ForceSink> create_force_sink(const std::filesystem::path& path,
                                             const ForceFileInfo& info, Replace replace) {
  check(info, path.string());
  const OutputKind kind = kind_of_force_file(path);
  if (kind == OutputKind::forces) return create_hdf5_sink(path, info, replace);
  if (info.contacts) {
    throw Error(path.string(), "only HDF5 files hold contacts beside the forces",
                "end it in .h5, or write the contacts to a file of their own");
  }
  if (kind == OutputKind::force_table) return create_csv_sink(path, info, replace);
  return create_npy_sink(path, info, replace);
}

}  // namespace pillarfield
