#include "streams/message/messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "pillarfield/status.h"
#include "skin/vectors.h"
#include "solve/result_planes.h"

namespace pillarfield {
namespace {

/// The index of the pillar nearest to `offset_mm` from the first one.
std::size_t nearest_pillar(double offset_mm, double pitch_mm, std::uint32_t pillars) {
  const double index = std::round(offset_mm / pitch_mm);
  return static_cast<std::size_t>(std::clamp(index, 0.0, static_cast<double>(pillars - 1)));
}

}  // namespace

SkinGeometry::SkinGeometry(const LiveSinkInfo& info)
    : surface_(info.forces.surface.value_or(Surface{})),
      layout_{info.forces.rows, info.forces.cols, info.forces.element_pitch_mm},
      poses_(poses_of(surface_, layout_)) {}

Pose SkinGeometry::pose_of(const PatchPlace& place) const {
  if (surface_.shape != SurfaceShape::height_map) {
    return pose_at(surface_, place.x_mm, place.y_mm);
  }
  const double left_mm = -0.5 * (layout_.cols - 1) * layout_.pitch_mm.col_mm;
  const double top_mm = 0.5 * (layout_.rows - 1) * layout_.pitch_mm.row_mm;
  const std::size_t row =
      nearest_pillar(top_mm - place.y_mm, layout_.pitch_mm.row_mm, layout_.rows);
  const std::size_t col =
      nearest_pillar(place.x_mm - left_mm, layout_.pitch_mm.col_mm, layout_.cols);
  return poses_[row * layout_.cols + col];
}

Vector3 force_of(const ContactQuantities& contact, const Pose& pose) {
  if (contact.wrench) return contact.wrench->force_n;
  return contact.shear_x_n * pose.tangent_x + contact.shear_y_n * pose.tangent_y -
         contact.normal_n * pose.normal;
}

}  // namespace pillarfield

namespace pillarfield::message {
namespace {

constexpr std::string_view kFrameId = "skin";
constexpr std::string_view kFlatFrameId = "skin_flat";
constexpr double kMetresPerMm = 1e-3;

/// builtin_interfaces/Time, within the range of its 32-bit seconds.
void put_stamp(CdrWriter& cdr, Stamp stamp) {
  using std::chrono::seconds;
  constexpr seconds kLargest{std::numeric_limits<std::int32_t>::max()};
  const seconds whole = std::clamp(std::chrono::floor<seconds>(stamp), -kLargest, kLargest);
  const std::int64_t rest = std::clamp<std::int64_t>((stamp - whole).count(), 0, 999'999'999);
  cdr.put_all(static_cast<std::int32_t>(whole.count()), static_cast<std::uint32_t>(rest));
}

void put_header(CdrWriter& cdr, Stamp stamp) {
  put_stamp(cdr, stamp);
  cdr.put(kFrameId);
}

void put_vector(CdrWriter& cdr, const Vector3& vector) {
  cdr.put_all(vector.x, vector.y, vector.z);
}

struct Pixels {
  std::uint32_t rows;
  std::uint32_t cols;
  std::string_view encoding;
  std::uint32_t bytes_each;
};

/// The message but for its pixels, which are to be written to the result.
std::byte* put_image(CdrWriter& cdr, Stamp stamp, const Pixels& pixels) {
  constexpr std::uint8_t kLittleEndian = 0;
  put_header(cdr, stamp);
  cdr.put_all(pixels.rows, pixels.cols, pixels.encoding, kLittleEndian,
              pixels.cols * pixels.bytes_each);
  return cdr.put_space(std::size_t{pixels.rows} * pixels.cols * pixels.bytes_each);
}

const char* encoding_of(SenselType type) {
  switch (type) {
    case SenselType::u8:
      return "mono8";
    case SenselType::u16:
      return "mono16";
    case SenselType::f32:
      break;
  }
  return "32FC1";
}

/// A point of the cloud as stored.
struct Point {
  float x, y, z;                   // m
  float shear_x, shear_y, normal;  // N
  std::uint32_t status;
};

constexpr std::uint32_t kPointBytes = 28;
static_assert(sizeof(Point) == kPointBytes);

void put_point_fields(CdrWriter& cdr) {
  constexpr std::uint8_t kUint32 = 6;
  constexpr std::uint8_t kFloat32 = 7;
  constexpr std::array<std::string_view, 7> kNames = {"x",       "y",      "z",     "shear_x",
                                                      "shear_y", "normal", "status"};
  cdr.put_length(kNames.size());
  std::uint32_t offset = 0;
  for (const std::string_view name : kNames) {
    cdr.put_all(name, offset, name == "status" ? kUint32 : kFloat32, std::uint32_t{1});
    offset += sizeof(float);
  }
}

/// Calls `visit` with the name and the values of each plane of the field, absent ones left out.
template <class Visit>
void visit_planes(const ForceFieldView& forces, const Visit& visit) {
  const std::size_t pillars = std::size_t{forces.rows} * forces.cols;
  for (std::size_t plane = 0; plane < kSolvedPlanes; ++plane) {
    const std::span<const float> values = plane_of(forces, plane);
    if (values.size() == pillars) visit(kResultPlanes[plane].field(), values);
  }
  if (forces.status.size() == pillars) visit(std::string("status"), forces.status);
}

/// A cell of a Grid: a value of each plane, without gaps.
struct Cell {
  std::uint32_t planes = 0;
  std::uint32_t bytes = 0;
};

Cell cell_of(const ForceFieldView& forces) {
  Cell cell;
  visit_planes(forces, [&](const std::string&, const auto& plane) {
    ++cell.planes;
    cell.bytes += static_cast<std::uint32_t>(sizeof plane[0]);
  });
  return cell;
}

/// foxglove_msgs/PackedElementField.
void put_cell_field(CdrWriter& cdr, std::string_view name, std::uint32_t offset,
                    std::size_t bytes) {
  constexpr std::uint8_t kUint8 = 1;
  constexpr std::uint8_t kFloat32 = 7;
  cdr.put_all(name, offset, bytes == sizeof(float) ? kFloat32 : kUint8);
}

/// Writes a plane into cells of a Grid, its last row first.
template <class Value>
void put_cells(std::span<const Value> plane, std::uint32_t cols, std::uint32_t cell_bytes,
               std::byte* cell) {
  for (std::size_t end = plane.size(); end > 0; end -= cols) {
    for (const Value value : plane.subspan(end - cols, cols)) {
      std::memcpy(cell, &value, sizeof value);
      cell += cell_bytes;
    }
  }
}

void find_touched(std::span<const std::uint8_t> status, std::vector<std::uint32_t>& touched) {
  touched.clear();
  for (std::size_t pillar = 0; pillar < status.size(); ++pillar) {
    if ((status[pillar] & status::kLoaded) != 0) {
      touched.push_back(static_cast<std::uint32_t>(pillar));
    }
  }
}

/// visualization_msgs/Marker up to `points`.
struct Marker {
  std::string_view name_space;
  std::int32_t id;
  std::int32_t action;
};
constexpr std::int32_t kAdd = 0;
constexpr std::int32_t kDeleteAll = 3;

void put_marker_head(CdrWriter& cdr, Stamp stamp, const Marker& marker) {
  constexpr std::int32_t kArrowType = 0;
  constexpr Vector3 kShaftHeadLengthM = {0.001, 0.0025, 0.003};
  constexpr std::array<float, 4> kOrange = {0.90f, 0.45f, 0.05f, 1.0f};
  put_header(cdr, stamp);
  cdr.put_all(marker.name_space, marker.id, kArrowType, marker.action);
  put_vector(cdr, {});              // position
  cdr.put_all(0.0, 0.0, 0.0, 1.0);  // orientation: none
  put_vector(cdr, kShaftHeadLengthM);
  for (const float part : kOrange) cdr.put(part);
  cdr.put_all(std::int32_t{0}, std::uint32_t{0}, std::uint8_t{0});  // stays; not locked
}

/// visualization_msgs/Marker after `points`: nothing.
void put_marker_tail(CdrWriter& cdr) {
  cdr.put_length(0);  // colors
  cdr.put(std::string_view());
  put_stamp(cdr, Stamp{0});  // texture
  cdr.put_all(std::string_view(), std::string_view());
  cdr.put_length(0);
  cdr.put_length(0);  // uv_coordinates
  cdr.put_all(std::string_view(), std::string_view(), std::string_view());
  cdr.put_length(0);  // mesh_file.data
  cdr.put(std::uint8_t{0});
}

void put_arrow(CdrWriter& cdr, Stamp stamp, const Arrow& arrow, const SkinGeometry& geometry) {
  constexpr double kMetresPerNewton = 0.01;
  constexpr std::uint64_t kIds = std::numeric_limits<std::int32_t>::max();
  const TrackedContact& contact = *arrow.contact;
  const Pose pose = geometry.pose_of(contact.quantities.centre_of_pressure);
  const Vector3 tip = kMetresPerMm * pose.position_mm;
  put_marker_head(cdr, stamp,
                  {arrow.name_space, static_cast<std::int32_t>(contact.track_id % kIds), kAdd});
  cdr.put_length(2);
  put_vector(cdr, tip - kMetresPerNewton * force_of(contact.quantities, pose));
  put_vector(cdr, tip);
  put_marker_tail(cdr);
}

/// diagnostic_msgs/DiagnosticStatus's level and message.
struct Level {
  std::uint8_t level;
  const char* text;
};

Level level_of(const HealthReport& health, std::uint64_t lost_before) {
  if (health.since_frame_s > 1) return {3, "no frames arrive"};
  if (health.stream.lost > lost_before) return {1, "frames are lost"};
  if (health.dead + health.stuck > 0) return {1, "sensels are dead or stuck"};
  if (health.drifting > 0) return {1, "sensels drift"};
  return {0, "frames arrive"};
}

void put_values(CdrWriter& cdr, const HealthReport& health) {
  const StreamHealth& stream = health.stream;
  const std::array<std::pair<std::string_view, std::string>, 18> values = {{
      {"rate_hz", fmt::format("{}", stream.rate_hz)},
      {"frames", fmt::format("{}", stream.frames)},
      {"lost", fmt::format("{}", stream.lost)},
      {"incomplete", fmt::format("{}", stream.incomplete)},
      {"late", fmt::format("{}", stream.late)},
      {"duplicates", fmt::format("{}", stream.duplicates)},
      {"reordered", fmt::format("{}", stream.reordered)},
      {"invalid", fmt::format("{}", stream.invalid)},
      {"restarts", fmt::format("{}", stream.restarts)},
      {"clock_jumps", fmt::format("{}", stream.clock_jumps)},
      {"overrun", fmt::format("{}", stream.overrun)},
      {"solved", fmt::format("{}", health.solved)},
      {"latency_ms_median", fmt::format("{}", health.latency_ms_median)},
      {"latency_ms_worst", fmt::format("{}", health.latency_ms_worst)},
      {"since_frame_s", fmt::format("{}", health.since_frame_s)},
      {"dead", fmt::format("{}", health.dead)},
      {"stuck", fmt::format("{}", health.stuck)},
      {"drifting", fmt::format("{}", health.drifting)},
  }};
  cdr.put_length(values.size());
  for (const auto& [key, value] : values) cdr.put_all(key, std::string_view(value));
}

}  // namespace

void put_normal_image(CdrWriter& cdr, Stamp stamp, const ForceFieldView& forces) {
  std::byte* const pixels =
      put_image(cdr, stamp, {forces.rows, forces.cols, "32FC1", sizeof(float)});
  std::memcpy(pixels, forces.normal.data(), forces.normal.size_bytes());
}

void put_raw_image(CdrWriter& cdr, Stamp stamp, const FrameView& readings) {
  const auto bytes_each = static_cast<std::uint32_t>(size_of(readings.type));
  std::byte* pixels =
      put_image(cdr, stamp, {readings.rows, readings.cols, encoding_of(readings.type), bytes_each});
  const auto* row = static_cast<const std::byte*>(readings.data);
  const std::size_t row_bytes = std::size_t{readings.cols} * bytes_each;
  for (std::uint32_t i = 0; i < readings.rows; ++i) {
    std::memcpy(pixels, row, row_bytes);
    pixels += row_bytes;
    row += readings.row_stride * bytes_each;
  }
}

void put_points(CdrWriter& cdr, Stamp stamp, const ForceFieldView& forces,
                const std::vector<Pose>& poses, std::vector<std::uint32_t>& touched) {
  find_touched(forces.status, touched);
  const auto points = static_cast<std::uint32_t>(touched.size());
  put_header(cdr, stamp);
  cdr.put_all(std::uint32_t{1}, points);
  put_point_fields(cdr);
  cdr.put_all(std::uint8_t{0}, kPointBytes, kPointBytes * points);
  std::byte* out = cdr.put_space(std::size_t{kPointBytes} * points);
  for (const std::uint32_t pillar : touched) {
    const Vector3 place = kMetresPerMm * poses[pillar].position_mm;
    const Point point = {static_cast<float>(place.x), static_cast<float>(place.y),
                         static_cast<float>(place.z), forces.shear_x[pillar],
                         forces.shear_y[pillar],      forces.normal[pillar],
                         forces.status[pillar]};
    std::memcpy(out, &point, kPointBytes);
    out += kPointBytes;
  }
  cdr.put(std::uint8_t{1});  // is_dense: all points are valid
}

void put_field(CdrWriter& cdr, Stamp stamp, const ForceFieldView& forces,
               const SkinGeometry& geometry) {
  const Pitch pitch_m = kMetresPerMm * geometry.pitch_mm();
  const Cell cell = cell_of(forces);
  put_stamp(cdr, stamp);
  cdr.put(geometry.is_flat() ? kFrameId : kFlatFrameId);
  put_vector(cdr, {-0.5 * pitch_m.col_mm * forces.cols, -0.5 * pitch_m.row_mm * forces.rows, 0});
  cdr.put_all(0.0, 0.0, 0.0, 1.0);  // orientation: none
  cdr.put_all(forces.cols, pitch_m.col_mm, pitch_m.row_mm, forces.cols * cell.bytes, cell.bytes);
  cdr.put_length(cell.planes);
  std::uint32_t offset = 0;
  visit_planes(forces, [&](const std::string& name, const auto& plane) {
    put_cell_field(cdr, name, offset, sizeof plane[0]);
    offset += static_cast<std::uint32_t>(sizeof plane[0]);
  });
  std::byte* first = cdr.put_space(std::size_t{forces.rows} * forces.cols * cell.bytes);
  visit_planes(forces, [&](const std::string&, const auto& plane) {
    put_cells(plane, forces.cols, cell.bytes, first);
    first += sizeof plane[0];
  });
}

void put_wrench(CdrWriter& cdr, Stamp stamp, const ContactQuantities* contact) {
  put_header(cdr, stamp);
  Vector3 force;
  Vector3 moment_nmm;
  if (contact != nullptr && contact->wrench) {
    force = contact->wrench->force_n;
    moment_nmm = contact->wrench->moment_nmm;
  } else if (contact != nullptr) {
    const Moment moment = moment_about({}, *contact);
    force = {contact->shear_x_n, contact->shear_y_n, -contact->normal_n};
    moment_nmm = {moment.x_nmm, moment.y_nmm, moment.z_nmm};
  }
  put_vector(cdr, force);
  put_vector(cdr, kMetresPerMm * moment_nmm);
}

void put_arrows(CdrWriter& cdr, Stamp stamp, std::span<const Arrow> arrows,
                const SkinGeometry& geometry) {
  cdr.put_length(arrows.size() + 1);
  put_marker_head(cdr, stamp, {"", 0, kDeleteAll});
  cdr.put_length(0);
  put_marker_tail(cdr);
  for (const Arrow& arrow : arrows) put_arrow(cdr, stamp, arrow, geometry);
}

void put_time(CdrWriter& cdr, Stamp stamp, double time_s, std::string_view source) {
  constexpr double kLargest = 2e9;
  put_header(cdr, stamp);
  const double time = std::isfinite(time_s) ? std::clamp(time_s, -kLargest, kLargest) : 0;
  const double whole = std::floor(time);
  put_stamp(cdr, std::chrono::seconds(static_cast<std::int64_t>(whole)) +
                     Stamp(std::llround((time - whole) * 1e9)));
  cdr.put(source);
}

void put_health(CdrWriter& cdr, Stamp stamp, const HealthReport& health, std::string_view source,
                std::uint64_t lost_before) {
  const Level level = level_of(health, lost_before);
  put_header(cdr, stamp);
  cdr.put_length(1);
  cdr.put_all(level.level, std::string_view("pillarfield"), std::string_view(level.text), source);
  put_values(cdr, health);
}

}  // namespace pillarfield::message
