#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "pillarfield/live.h"
#include "streams/message/cdr.h"
#include "streams/message/skin_geometry.h"

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
