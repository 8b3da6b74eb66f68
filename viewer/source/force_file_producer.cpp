#include "viewer/source/force_file_producer.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "pillarfield/error.h"
#include "pillarfield/solver_plan.h"
#include "viewer/source/field_producer.h"

namespace pillarfield::viewer {
namespace {

std::string solver_of(const ForceFileInfo& info) {
  if (info.estimator.empty()) return "not known";
  return solver_words(info.layout, info.estimator, info.device);
}

SourceInfo info_of(const std::filesystem::path& path, const ForceFileReader& reader) {
  const ForceFileInfo& file = reader.info();
  if (reader.frames() == 0) {
    throw Error(path.string(), "it has no frames", "give a file with at least one frame");
  }
  SourceInfo info;
  info.name = path.filename().string();
  info.kind = "force field";
  const std::uint32_t side = file.layout == SkinLayout::pillars ? 2 : 1;  // in sensels
  info.skin.layout = file.layout;
  info.skin.rows = side * file.rows;
  info.skin.cols = side * file.cols;
  info.skin.sensel_pitch_mm = (1.0 / side) * file.element_pitch_mm;
  info.skin.surface = file.surface;
  info.contacts.layout = file.layout;
  info.contacts.surface = file.surface;
  info.contacts.effects = file.effects;
  info.frames = reader.frames();
  info.has_angles = info.skin.has_pillars();
  info.has_uncertainty = file.uncertainty;
  info.solver = solver_of(file);
  info.warnings = reader.warnings();
  return info;
}

/// The argument of component_ends().
std::optional<double> direct_point_of(const ForceFileInfo& file) {
  return file.estimator == name_of(Estimator::direct) ? file.segment_point : std::nullopt;
}

float nan_unless(bool holds, double value) {
  return holds ? static_cast<float>(value) : std::numeric_limits<float>::quiet_NaN();
}

}  // namespace

ForceFileProducer::ForceFileProducer(const std::filesystem::path& path, ReadOptions options)
    : file_(path),
      read_(std::move(options)),
      reader_(std::in_place, path, read_),
      info_(info_of(path, *reader_)),
      blocks_(kMostShown, [this] {
        return std::make_unique<PlaneBlock>(info_.skin.layout, info_.skin.element_rows(),
                                            info_.skin.element_cols(), info_.has_uncertainty);
      }) {
  info_.rate_hz = frame_rate(info_.frames,
                             [this](std::uint64_t index) { return reader_->read(index, forces_); });
}

ShownField ForceFileProducer::produce(std::uint64_t index) {
  if (!reader_) open(file_.path());
  const std::shared_ptr<PlaneBlock> block = blocks_.acquire();
  if (block == nullptr) throw_all_fields_in_use();
  const double time_s = reader_->read(index, forces_);
  block->copy(forces_.view());
  return {
      .forces = block->view(),
      .raw = {},
      .time_s = time_s,
      .index = index,
      .direct_point = direct_point_of(reader_->info()),
      .shear_coefficient = reader_->info().effects.shear_coefficient.value_or(ShearCoefficient{}),
      .pages = block->pages(),
      .keep_alive = block};
}

ShownContacts ForceFileProducer::contacts_of(const ShownField& field) {
  if (!reader_->info().contacts) return FieldProducer::contacts_of(field);
  map_.find(field.forces.status, field.forces.rows, field.forces.cols);
  return with_extents(reader_->read_contacts(field.index), map_);
}

std::optional<CurvePoint> ForceFileProducer::stored_total(std::uint64_t index) {
  if (!reader_ || !reader_->info().contacts) return std::nullopt;
  const FrameContacts found = reader_->read_contacts(index);
  const ContactQuantities& total = found.total;
  const bool loaded = total.normal_n > 0;
  return CurvePoint{.time_s = found.time_s,
                    .index = index,
                    .shear_x = static_cast<float>(total.shear_x_n),
                    .shear_y = static_cast<float>(total.shear_y_n),
                    .normal = static_cast<float>(total.normal_n),
                    .torque = nan_unless(loaded, total.torque_nmm),
                    .centre_x_mm = nan_unless(loaded, total.centre_of_pressure.x_mm),
                    .centre_y_mm = nan_unless(loaded, total.centre_of_pressure.y_mm)};
}

void ForceFileProducer::open(const std::filesystem::path& path) {
  ForceFileReader reader(path, read_);
  const ForceFileInfo& found = reader.info();
  if (found.layout != info_.skin.layout || found.rows != info_.skin.element_rows() ||
      found.cols != info_.skin.element_cols() || found.uncertainty != info_.has_uncertainty ||
      reader.frames() == 0) {
    throw Error(path.string(), "it was replaced by another force file", "open it again");
  }
  reader_ = std::move(reader);
}

bool ForceFileProducer::refresh() {
  if (!file_.may_have_changed()) return false;
  reader_.reset();  // HDF5 does not show new data in a file that it holds open.
  if (!file_.reopen([this](const std::filesystem::path& path) { open(path); })) return false;
  const std::uint64_t before = std::exchange(info_.frames, reader_->frames());
  return info_.frames != before;
}

}  // namespace pillarfield::viewer
