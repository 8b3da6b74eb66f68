#include "streams/message/topics.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string_view>

namespace pillarfield {

const std::array<ContactSlots::Slot, ContactSlots::kSlots>& ContactSlots::update(
    const FrameContacts& contacts) {
  slots_ = {};
  const auto place_of = [&](std::uint64_t track) {
    return static_cast<std::size_t>(std::ranges::find(tracks_, track) - tracks_.begin());
  };
  for (const TrackedContact& contact : contacts.contacts) {
    const std::size_t place = place_of(contact.track_id);
    if (place < kSlots) slots_[place].contact = &contact;
  }
  for (std::size_t place = 0; place < kSlots; ++place) {
    slots_[place].ended = tracks_[place] != 0 && slots_[place].contact == nullptr;
    if (slots_[place].ended) tracks_[place] = 0;
  }
  for (const TrackedContact& contact : contacts.contacts) {
    if (place_of(contact.track_id) < kSlots) continue;
    const std::size_t place = place_of(0);
    if (place == kSlots) break;
    tracks_[place] = contact.track_id;
    slots_[place].contact = &contact;
  }
  return slots_;
}

namespace {

/// A message and its members.
struct Definition {
  std::string_view name;
  std::string_view members;
};

constexpr Definition kTime = {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"};
constexpr Definition kDuration = {"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"};
constexpr Definition kHeader = {"std_msgs/Header",
                                "builtin_interfaces/Time stamp\nstring frame_id\n"};
constexpr Definition kColor = {"std_msgs/ColorRGBA",
                               "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"};
constexpr Definition kVector = {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"};
constexpr Definition kPoint = {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"};
constexpr Definition kQuaternion = {"geometry_msgs/Quaternion",
                                    "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"};
constexpr Definition kPose = {
    "geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"};
constexpr Definition kWrench = {"geometry_msgs/Wrench",
                                "geometry_msgs/Vector3 force\ngeometry_msgs/Vector3 torque\n"};
constexpr Definition kWrenchStamped = {"geometry_msgs/WrenchStamped",
                                       "std_msgs/Header header\ngeometry_msgs/Wrench wrench\n"};
constexpr Definition kImage = {"sensor_msgs/Image",
                               "std_msgs/Header header\n"
                               "uint32 height\nuint32 width\nstring encoding\n"
                               "uint8 is_bigendian\nuint32 step\nuint8[] data\n"};
constexpr Definition kCompressedImage = {"sensor_msgs/CompressedImage",
                                         "std_msgs/Header header\nstring format\nuint8[] data\n"};
constexpr Definition kPointField = {"sensor_msgs/PointField",
                                    "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\n"
                                    "uint8 INT32=5\nuint8 UINT32=6\nuint8 FLOAT32=7\n"
                                    "uint8 FLOAT64=8\n"
                                    "string name\nuint32 offset\nuint8 datatype\nuint32 count\n"};
constexpr Definition kPointCloud = {"sensor_msgs/PointCloud2",
                                    "std_msgs/Header header\nuint32 height\nuint32 width\n"
                                    "sensor_msgs/PointField[] fields\nbool is_bigendian\n"
                                    "uint32 point_step\nuint32 row_step\nuint8[] data\n"
                                    "bool is_dense\n"};
constexpr Definition kVector2 = {"foxglove_msgs/Vector2", "float64 x\nfloat64 y\n"};
constexpr Definition kPackedField = {"foxglove_msgs/PackedElementField",
                                     "uint8 UNKNOWN=0\nuint8 UINT8=1\nuint8 INT8=2\n"
                                     "uint8 UINT16=3\nuint8 INT16=4\nuint8 UINT32=5\n"
                                     "uint8 INT32=6\nuint8 FLOAT32=7\nuint8 FLOAT64=8\n"
                                     "string name\nuint32 offset\nuint8 type\n"};
constexpr Definition kGrid = {"foxglove_msgs/Grid",
                              "builtin_interfaces/Time timestamp\nstring frame_id\n"
                              "geometry_msgs/Pose pose\nuint32 column_count\n"
                              "foxglove_msgs/Vector2 cell_size\n"
                              "uint32 row_stride\nuint32 cell_stride\n"
                              "foxglove_msgs/PackedElementField[] fields\nuint8[] data\n"};
constexpr Definition kTimeReference = {
    "sensor_msgs/TimeReference",
    "std_msgs/Header header\nbuiltin_interfaces/Time time_ref\nstring source\n"};
constexpr Definition kTextureCoordinate = {"visualization_msgs/UVCoordinate",
                                           "float32 u\nfloat32 v\n"};
constexpr Definition kMeshFile = {"visualization_msgs/MeshFile", "string filename\nuint8[] data\n"};
constexpr Definition kMarker = {
    "visualization_msgs/Marker",
    "int32 ARROW=0\nint32 CUBE=1\nint32 SPHERE=2\nint32 CYLINDER=3\nint32 LINE_STRIP=4\n"
    "int32 LINE_LIST=5\nint32 CUBE_LIST=6\nint32 SPHERE_LIST=7\nint32 POINTS=8\n"
    "int32 TEXT_VIEW_FACING=9\nint32 MESH_RESOURCE=10\nint32 TRIANGLE_LIST=11\n"
    "int32 ARROW_STRIP=12\n"
    "int32 ADD=0\nint32 MODIFY=0\nint32 DELETE=2\nint32 DELETEALL=3\n"
    "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\n"
    "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\n"
    "builtin_interfaces/Duration lifetime\nbool frame_locked\ngeometry_msgs/Point[] points\n"
    "std_msgs/ColorRGBA[] colors\nstring texture_resource\n"
    "sensor_msgs/CompressedImage texture\nvisualization_msgs/UVCoordinate[] uv_coordinates\n"
    "string text\nstring mesh_resource\nvisualization_msgs/MeshFile mesh_file\n"
    "bool mesh_use_embedded_materials\n"};
constexpr Definition kMarkerArray = {"visualization_msgs/MarkerArray",
                                     "visualization_msgs/Marker[] markers\n"};
constexpr Definition kKeyValue = {"diagnostic_msgs/KeyValue", "string key\nstring value\n"};
constexpr Definition kDiagnosticStatus = {
    "diagnostic_msgs/DiagnosticStatus",
    "byte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\n"
    "byte level\nstring name\nstring message\nstring hardware_id\n"
    "diagnostic_msgs/KeyValue[] values\n"};
constexpr Definition kDiagnosticArray = {
    "diagnostic_msgs/DiagnosticArray",
    "std_msgs/Header header\ndiagnostic_msgs/DiagnosticStatus[] status\n"};

/// The schema of the first definition; the others are the messages that it contains.
MessageSchema schema_of(std::initializer_list<Definition> definitions) {
  const Definition& message = *definitions.begin();
  const std::size_t slash = message.name.find('/');
  MessageSchema schema;
  schema.name =
      std::string(message.name.substr(0, slash)) + "/msg" + std::string(message.name.substr(slash));
  for (const Definition& definition : definitions) {
    if (!schema.definition.empty()) {
      schema.definition += std::string(80, '=') + "\nMSG: " + std::string(definition.name) + "\n";
    }
    schema.definition += definition.members;
  }
  return schema;
}

}  // namespace

const MessageSchema& image_schema() {
  static const MessageSchema schema = schema_of({kImage, kHeader, kTime});
  return schema;
}

const MessageSchema& point_cloud_schema() {
  static const MessageSchema schema = schema_of({kPointCloud, kHeader, kTime, kPointField});
  return schema;
}

const MessageSchema& grid_schema() {
  static const MessageSchema schema =
      schema_of({kGrid, kTime, kPose, kPoint, kQuaternion, kVector2, kPackedField});
  return schema;
}

const MessageSchema& wrench_schema() {
  static const MessageSchema schema = schema_of({kWrenchStamped, kHeader, kTime, kWrench, kVector});
  return schema;
}

const MessageSchema& marker_array_schema() {
  static const MessageSchema schema =
      schema_of({kMarkerArray, kMarker, kHeader, kTime, kPose, kPoint, kQuaternion, kVector, kColor,
                 kDuration, kCompressedImage, kTextureCoordinate, kMeshFile});
  return schema;
}

const MessageSchema& diagnostics_schema() {
  static const MessageSchema schema =
      schema_of({kDiagnosticArray, kHeader, kTime, kDiagnosticStatus, kKeyValue});
  return schema;
}

const MessageSchema& time_reference_schema() {
  static const MessageSchema schema = schema_of({kTimeReference, kHeader, kTime});
  return schema;
}

std::span<const Topic> topics() {
  static const auto all = [] {
    std::array<Topic, kTopics> list;
    list[topic::kNormal] = {"/skin/normal", &image_schema()};
    list[topic::kRaw] = {"/skin/raw", &image_schema()};
    list[topic::kForces] = {"/skin/forces", &point_cloud_schema()};
    list[topic::kField] = {"/skin/field", &grid_schema()};
    list[topic::kArrows] = {"/skin/arrows", &marker_array_schema()};
    list[topic::kHealth] = {"/skin/health", &diagnostics_schema()};
    list[topic::kTime] = {"/skin/time", &time_reference_schema()};
    for (std::size_t slot = 0; slot < ContactSlots::kSlots; ++slot) {
      list[topic::kContacts + slot] = {"/skin/contacts/" + std::to_string(slot + 1),
                                       &wrench_schema()};
    }
    return list;
  }();
  return all;
}

TopicSet contact_topics() { return TopicSet().set() << topic::kContacts; }

}  // namespace pillarfield
