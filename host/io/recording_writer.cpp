#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "io/hdf5/file.h"
#include "io/hdf5/frames.h"
#include "io/hdf5/stored_frames.h"
#include "io/hdf5/tiled_frames.h"
#include "io/recording_format.h"
#include "io/stored_skin.h"
#include "pillarfield/error.h"
#include "pillarfield/recording.h"

namespace pillarfield {
namespace {

std::filesystem::path checked(const std::filesystem::path& path, const Skin& skin, SenselType type,
                              const Calibration& calibration,
                              const RecordingWriter::Options& options) {
  check(skin, path.c_str());
  check(calibration, skin, path.c_str(), type);
  if (options.flush_every == 0) throw Error(path.string(), "flush_every is 0", "flush every frame");
  return path;
}

hid_t stored_type_of(SenselType type) {
  if (type == SenselType::u8) return H5T_STD_U8LE;
  return type == SenselType::u16 ? H5T_STD_U16LE : H5T_IEEE_F32LE;
}

hid_t memory_type_of(SenselType type) {
  if (type == SenselType::u8) return H5T_NATIVE_UINT8;
  return type == SenselType::u16 ? H5T_NATIVE_UINT16 : H5T_NATIVE_FLOAT;
}

}  // namespace

struct RecordingWriter::State {
  State(const std::filesystem::path& final_path, const Skin& frame_skin, SenselType sensel_type,
        const Calibration& calibration, const Options& writer_options);
  ~State();

  void create_datasets();
  void check_frame(const FrameView& frame, double time_s, const ForceField* field) const;
  void put_truth(const ForceField& field);
  void append(const FrameView& frame, double time_s, const ForceField* field,
              std::uint32_t missing_sensels);
  void require_open() const;
  [[nodiscard]] bool has_truth_plane(std::size_t plane) const {
    return recording_format::has_truth_plane(skin, plane);
  }
  void flush();
  void close();

  Skin skin;
  SenselType type;
  Options options;
  std::filesystem::path path;
  OutputFile part;
  hdf5::File file;
  hdf5::ExtendibleDataset raw;
  hdf5::ExtendibleDataset time;
  hdf5::ExtendibleDataset missing;  // if options.missing
  bool has_tare;
  std::vector<float> holed;                // a frame with NaN where sensels are missing
  std::array<hdf5::TiledFrames, 3> truth;  // shear_x, shear_y, normal
  std::uint64_t frames = 0;
  std::uint64_t flushed = 0;
  double last_time_s = 0;
};

RecordingWriter::State::State(const std::filesystem::path& final_path, const Skin& frame_skin,
                              SenselType sensel_type, const Calibration& calibration,
                              const Options& writer_options)
    : skin(frame_skin),
      type(sensel_type),
      options(writer_options),
      path(checked(final_path, frame_skin, sensel_type, calibration, writer_options)),
      part(path, OutputKind::recording, writer_options.replace),
      file(hdf5::create(part)),
      has_tare(!calibration.tare.empty()) {
  const hdf5::Attributes root(file);
  root.write("format", std::string(recording_format::kName));
  root.write("version", !skin.has_pillars() ? recording_format::kLayoutSince
                        : options.truth     ? recording_format::kSparseTruthSince
                                            : 1);
  (void)write_skin(file, skin);
  write_planes(file, skin, calibration);
  if (skin.surface) write_surface(file, *skin.surface, skin.element_grid());
  create_datasets();
  hdf5::start_appending(file);
}

RecordingWriter::State::~State() {
  const bool unflushed_are_safe = file.write_status->error_number == 0;
  try {
    if (unflushed_are_safe) {
      for (auto& plane : truth) plane.flush();
    }
  } catch (const Error&) {
    // Readers take the frames that all datasets have.
  }
  if ((unflushed_are_safe ? frames : flushed) > 0) part.keep();
}

void RecordingWriter::State::create_datasets() {
  const hdf5::Handle group = hdf5::create_group(file, recording_format::kFrames);
  raw = {file, recording_format::kRaw, stored_type_of(type), {skin.rows, skin.cols}};
  time = {file, recording_format::kTime, H5T_IEEE_F64LE, {}};
  if (options.missing) missing = {file, recording_format::kMissing, H5T_STD_U32LE, {}};
  if (!options.truth) return;
  const hdf5::Handle truth_group = hdf5::create_group(file, recording_format::kTruth);
  for (std::size_t plane = 0; plane < truth.size(); ++plane) {
    if (!has_truth_plane(plane)) continue;
    constexpr float kUntouched = 0;
    truth[plane] = {file,
                    recording_format::kTruthPlanes[plane],
                    H5T_IEEE_F32LE,
                    skin.element_rows(),
                    skin.element_cols(),
                    &kUntouched};
  }
}

void RecordingWriter::State::check_frame(const FrameView& frame, double time_s,
                                         const ForceField* field) const {
  const std::string where = fmt::format("{}: frame {}", part.part_path().string(), frames);
  check(frame, skin, type, where);
  if (!std::isfinite(time_s))
    throw Error(where, fmt::format("its time is {}", time_s), "give seconds");
  if (frames > 0 && time_s <= last_time_s) {
    throw Error(
        where,
        fmt::format("its time is {}, and that of the frame before it {}", time_s, last_time_s),
        "give times that rise from frame to frame");
  }
  if ((field != nullptr) != options.truth) {
    throw Error(where, options.truth ? "has no truth" : "has a truth",
                "set Options::truth if frames have one");
  }
  if (field == nullptr) return;
  const std::array planes = {&field->shear_x, &field->shear_y, &field->normal};
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const std::size_t values = has_truth_plane(i) ? skin.elements() : 0;
    if (planes[i]->size() != values || field->rows != skin.element_rows() ||
        field->cols != skin.element_cols()) {
      throw Error(where, fmt::format("its truth is {} x {}", field->rows, field->cols),
                  fmt::format("it needs {} x {} {}", skin.element_rows(), skin.element_cols(),
                              name_of(skin.layout)));
    }
  }
}

void RecordingWriter::State::put_truth(const ForceField& field) {
  const std::array planes = {&field.shear_x, &field.shear_y, &field.normal};
  for (std::size_t plane = 0; plane < planes.size(); ++plane) {
    if (!has_truth_plane(plane)) continue;
    truth[plane].append(planes[plane]->data());
  }
}

void RecordingWriter::State::append(const FrameView& frame, double time_s, const ForceField* field,
                                    std::uint32_t missing_sensels) {
  check_frame(frame, time_s, field);
  raw.put(frames, memory_type_of(type), frame.data, frame.row_stride);
  if (field != nullptr) put_truth(*field);
  time.put(frames, H5T_NATIVE_DOUBLE, &time_s);
  if (options.missing) missing.put(frames, H5T_NATIVE_UINT32, &missing_sensels);
  last_time_s = time_s;
  ++frames;
  if (frames % options.flush_every == 0) flush();
}

void RecordingWriter::State::require_open() const {
  if (file.id.valid()) return;
  throw Error(path.string(), "is finished", "start another recording");
}

void RecordingWriter::State::flush() {
  for (auto& plane : truth) plane.flush();
  hdf5::flush(file, frames);
  flushed = frames;
  part.sync_at_intervals();
}

void RecordingWriter::State::close() {
  raw.close();
  time.close();
  missing.close();
  for (auto& plane : truth) plane.close();
  hdf5::close(file);
}

RecordingWriter::RecordingWriter(const std::filesystem::path& path, const Skin& skin,
                                 SenselType type, const Calibration& calibration,
                                 const Options& options) {
  const hdf5::QuietErrors quiet;
  state_ = std::make_unique<State>(path, skin, type, calibration, options);
}

RecordingWriter::~RecordingWriter() {
  const hdf5::QuietErrors quiet;
  state_.reset();
}

RecordingWriter::RecordingWriter(RecordingWriter&&) noexcept = default;
RecordingWriter& RecordingWriter::operator=(RecordingWriter&&) noexcept = default;

void RecordingWriter::append(const FrameView& frame, double time_s, const ForceField* truth) {
  const hdf5::QuietErrors quiet;
  state_->require_open();
  state_->append(frame, time_s, truth, 0);
}

void RecordingWriter::append_incomplete(const FrameView& frame, double time_s,
                                        std::span<const SenselBlock> missing) {
  const hdf5::QuietErrors quiet;
  State& state = *state_;
  state.require_open();
  state.check_frame(frame, time_s, nullptr);
  if (!state.options.missing) {
    throw Error(state.path.string(), "a frame lacks sensels", "set Options::missing");
  }
  std::uint32_t sensels = 0;
  for (const SenselBlock& block : missing) {
    if (block.first_row > frame.rows || block.rows > frame.rows - block.first_row ||
        block.first_col > frame.cols || block.cols > frame.cols - block.first_col) {
      throw Error(state.path.string(), "a missing block lies outside the frame", "check the block");
    }
    sensels += block.rows * block.cols;
  }
  if (state.type != SenselType::f32) return state.append(frame, time_s, nullptr, sensels);
  state.holed.resize(std::size_t{frame.rows} * frame.cols);
  copy_readings(frame, std::as_writable_bytes(std::span(state.holed)).data());
  for (const SenselBlock& block : missing) {
    for (std::size_t row = block.first_row; row < block.first_row + block.rows; ++row) {
      std::fill_n(&state.holed[row * frame.cols + block.first_col], block.cols,
                  std::numeric_limits<float>::quiet_NaN());
    }
  }
  state.append({state.holed.data(), state.type, frame.rows, frame.cols, frame.cols}, time_s,
               nullptr, sensels);
}

void RecordingWriter::set_tare(const Calibration& calibration, double threshold_counts) {
  const hdf5::QuietErrors quiet;
  state_->require_open();
  if (!state_->has_tare) {
    throw Error(state_->path.string(), "was created without a tare", "give one, of zeros");
  }
  check(calibration, state_->skin, state_->path.string(), state_->type);
  if (calibration.tare.empty()) return;
  rewrite_tare(state_->file, calibration, threshold_counts);
}

void RecordingWriter::flush() {
  const hdf5::QuietErrors quiet;
  state_->require_open();
  state_->flush();
}

void RecordingWriter::finish() {
  const hdf5::QuietErrors quiet;
  state_->require_open();
  state_->flush();
  state_->close();
  state_->part.commit();
}

}  // namespace pillarfield
