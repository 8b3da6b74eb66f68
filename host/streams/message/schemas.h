#pragma once

#include <string>

namespace pillarfield {

/// The definition of a ROS 2 message.
struct MessageSchema {
  std::string name;        ///< "sensor_msgs/msg/Image"
  std::string definition;  ///< `ros2msg`: its members, then those of the messages it contains
};

/// Definitions as of ROS 2 Humble and later.
[[nodiscard]] const MessageSchema& image_schema();
[[nodiscard]] const MessageSchema& point_cloud_schema();
[[nodiscard]] const MessageSchema& wrench_schema();
[[nodiscard]] const MessageSchema& marker_array_schema();
[[nodiscard]] const MessageSchema& diagnostics_schema();
[[nodiscard]] const MessageSchema& time_reference_schema();

}  // namespace pillarfield
