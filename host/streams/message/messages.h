#pragma once

#include <bit>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "pillarfield/contact_quantities.h"
#include "pillarfield/live.h"
#include "pillarfield/surface.h"

namespace pillarfield {

/// Writes a message in CDR as ROS 2 does (OMG DDSI-RTPS 2.3, 10.2; plain CDR version 1,
/// little-endian): 4 bytes of encapsulation, then the members, each aligned to its own size from
/// the end of the encapsulation.
class CdrWriter {
 public:
  /// Starts a message in `out`, which loses its content and keeps its memory.
  explicit CdrWriter(std::vector<std::byte>& out) : out_(out) {
    out_.assign({std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}});
  }

  template <class T>
  requires std::is_arithmetic_v<T>
  void put(T value) {
    static_assert(std::endian::native == std::endian::little);
    align(sizeof(T));
    append(&value, sizeof value);
  }
  template <class... T>
  void put_all(T... values) {
    (put(values), ...);
  }
  void put(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size() + 1));
    append(text.data(), text.size());
    out_.push_back(std::byte{0});
  }
  /// The length of a sequence, whose elements follow.
  void put_length(std::size_t elements) { put(static_cast<std::uint32_t>(elements)); }
  void put_bytes(std::span<const std::byte> bytes) {
    put_length(bytes.size());
    append(bytes.data(), bytes.size());
  }
  /// Space for a sequence of bytes, to be filled before the next call.
  [[nodiscard]] std::byte* put_space(std::size_t bytes) {
    put_length(bytes);
    const std::size_t start = out_.size();
    out_.resize(start + bytes);
    return out_.data() + start;
  }

 private:
  static constexpr std::size_t kEncapsulation = 4;

  void align(std::size_t size) {
    while ((out_.size() - kEncapsulation) % size != 0) out_.push_back(std::byte{0});
  }
  void append(const void* data, std::size_t bytes) {
    const std::size_t start = out_.size();
    out_.resize(start + bytes);
    if (bytes > 0) std::memcpy(out_.data() + start, data, bytes);
  }

  std::vector<std::byte>& out_;
};

/// Places and directions of the pillars of a skin, flat if its surface is unknown.
class SkinGeometry {
 public:
  explicit SkinGeometry(const LiveSinkInfo& info);

  /// Poses of all pillars, row by row.
  [[nodiscard]] const std::vector<Pose>& poses() const { return poses_; }

  [[nodiscard]] const Pitch& pitch_mm() const { return layout_.pitch_mm; }
  [[nodiscard]] bool is_flat() const { return surface_.shape == SurfaceShape::plane; }

  /// Pose of a point of the skin; on a height map that of the nearest pillar.
  [[nodiscard]] Pose pose_of(const PatchPlace& place) const;

 private:
  Surface surface_;
  ElementGrid layout_;
  std::vector<Pose> poses_;
};

/// Force on the skin in the body's frame, N; `pose` is that of its place.
[[nodiscard]] Vector3 force_of(const ContactQuantities& contact, const Pose& pose);

}  // namespace pillarfield

/// The members of each message in CDR, in the frame of reference "skin" and in SI units: metres,
/// newtons, newton metres. `stamp` is the time of arrival since 1970.
namespace pillarfield::message {

using Stamp = std::chrono::nanoseconds;

/// sensor_msgs/Image, 32FC1, N.
void put_normal_image(CdrWriter& cdr, Stamp stamp, const ForceFieldView& forces);

/// sensor_msgs/Image: mono8, mono16 or 32FC1, counts.
void put_raw_image(CdrWriter& cdr, Stamp stamp, const FrameView& readings);

/// sensor_msgs/PointCloud2: x, y, z, shear_x, shear_y, normal and status of each pillar in contact.
/// `touched` is memory that the function reuses.
void put_points(CdrWriter& cdr, Stamp stamp, const ForceFieldView& forces,
                const std::vector<Pose>& poses, std::vector<std::uint32_t>& touched);

/// foxglove_msgs/Grid: every plane that the field has, each under its name in arrays of numbers
/// (docs/formats.md). Cells run from the lower left pillar to the right, then up. On a skin that is
/// not flat, the frame of reference is "skin_flat", the sheet before it was bent.
void put_field(CdrWriter& cdr, Stamp stamp, const ForceFieldView& forces,
               const SkinGeometry& geometry);

/// geometry_msgs/WrenchStamped: force on the skin and its moment about the origin; null: zeros.
void put_wrench(CdrWriter& cdr, Stamp stamp, const ContactQuantities* contact);

/// An arrow of a contact's force.
struct Arrow {
  const TrackedContact* contact = nullptr;
  std::string_view name_space;
};

/// visualization_msgs/MarkerArray: a marker that deletes the earlier ones, then the arrows, which
/// end at the centre of pressure; 1 N is 10 mm long.
void put_arrows(CdrWriter& cdr, Stamp stamp, std::span<const Arrow> arrows,
                const SkinGeometry& geometry);

/// sensor_msgs/TimeReference: the sensor's time.
void put_time(CdrWriter& cdr, Stamp stamp, double time_s, std::string_view source);

/// diagnostic_msgs/DiagnosticArray; `lost_before` is the number of lost frames in the previous one.
void put_health(CdrWriter& cdr, Stamp stamp, const HealthReport& health, std::string_view source,
                std::uint64_t lost_before);

}  // namespace pillarfield::message
