// Frames in the MCAP files that `stream --to FILE.mcap` writes: images of the topic /skin/raw.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <set>
#include <utility>

#include "base/input_file.h"
#include "io/frame_source.h"
#include "io/plain/inflater.h"
#include "io/plain/source.h"
#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"

namespace pillarfield {
namespace {

constexpr std::string_view kMcapFileMagic = "\x89MCAP0\r\n";
constexpr const char* kDamagedMcap = "the file is damaged or truncated; use another copy";

/// Types of records (mcap.dev, version 0).
enum class McapRecord : std::uint8_t { schema = 3, channel = 4, message = 5, chunk = 6, end = 15 };

/// Little-endian numbers and texts, one after another. Throws Error at the end of the bytes.
class McapCursor {
 public:
  McapCursor(std::string_view bytes, const std::string& place) : bytes_(bytes), place_(place) {}

  template <class Number>
  Number take() {
    Number number;
    std::memcpy(&number, take_bytes(sizeof number).data(), sizeof number);
    return number;
  }
  std::string_view take_text() { return take_bytes(take<std::uint32_t>()); }
  std::string_view take_bytes(std::uint64_t count) {
    if (count > left()) throw Error(place_, "a record is cut off", kDamagedMcap);
    at_ += count;
    return bytes_.substr(at_ - count, count);
  }
  void align_to_4() { take_bytes((4 - at_ % 4) % 4); }
  double take_stamp() {
    const auto seconds = take<std::int32_t>();
    return seconds + 1e-9 * take<std::uint32_t>();
  }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
  [[nodiscard]] std::size_t at() const { return at_; }

 private:
  std::string_view bytes_;
  const std::string& place_;
  std::size_t at_ = 0;
};

/// Reads a file from its beginning to its end, since a killed writer leaves out the index.
class McapReader {
 public:
  explicit McapReader(const std::filesystem::path& path) : file_(path), place_(path.string()) {
    constexpr std::uint64_t kHeadBytes = 9;  // type and length of a record
    for (std::uint64_t at = kMcapFileMagic.size(); at + kHeadBytes <= file_.size();) {
      const std::string head = file_.text_at(at, kHeadBytes);
      McapCursor cursor(head, place_);
      const auto record = McapRecord{cursor.take<std::uint8_t>()};
      const auto bytes = cursor.take<std::uint64_t>();
      at += kHeadBytes;
      if (record == McapRecord::end || bytes > file_.size() - at) break;
      if (record == McapRecord::chunk) add_chunk(at, bytes);
      if (record == McapRecord::schema || record == McapRecord::channel) {
        add(record, file_.text_at(at, std::min<std::uint64_t>(bytes, 1U << 20U)));
      }
      at += bytes;
    }
    if (times_s.empty()) refuse();
  }

  std::vector<double> times_s;
  std::vector<std::byte> pixels;
  NumberType type;
  std::vector<std::uint64_t> shape;  ///< rows, columns

 private:
  void add_chunk(std::uint64_t at, std::uint64_t bytes) {
    constexpr std::uint64_t kLeastInMcap = std::uint64_t{2} << 30U;
    if (is_interrupted()) throw Error(place_, "interrupted while it was read", "start again");
    const std::string head = file_.text_at(at, std::min<std::uint64_t>(bytes, 64));
    McapCursor cursor(head, place_);
    cursor.take_bytes(16);  // the first and the last time
    const auto inflated_bytes = cursor.take<std::uint64_t>();
    cursor.take<std::uint32_t>();  // the checksum
    const std::string compression(cursor.take_text());
    const auto stored_bytes = cursor.take<std::uint64_t>();
    if (compression != "zstd") {
      throw Error(place_, fmt::format("its chunks are compressed by {:.20}", compression),
                  "write it with zstd: mcap compress --compression zstd");
    }
    inflated_bytes_ += inflated_bytes;
    if (stored_bytes > bytes - cursor.at() || inflated_bytes > most_inflated(stored_bytes) ||
        inflated_bytes_ > std::max(kLeastInMcap, kMostDeflateRatio * file_.size())) {
      throw Error(place_,
                  fmt::format("a chunk of {} bytes claims {}", stored_bytes, inflated_bytes),
                  kDamagedMcap);
    }
    const std::string stored = file_.text_at(at + cursor.at(), stored_bytes);
    std::string messages(inflated_bytes, '\0');
    if (ZSTD_decompress(messages.data(), messages.size(), stored.data(), stored.size()) !=
        messages.size()) {
      throw Error(place_, "has a chunk of another size than it states", kDamagedMcap);
    }
    for (McapCursor records(messages, place_); records.left() > 0;) {
      const auto record = McapRecord{records.take<std::uint8_t>()};
      add(record, records.take_bytes(records.take<std::uint64_t>()));
    }
  }

  void add(McapRecord record, std::string_view content) {
    McapCursor cursor(content, place_);
    if (record == McapRecord::schema) {
      const auto id = cursor.take<std::uint16_t>();
      schemas_[id] = cursor.take_text();
    } else if (record == McapRecord::channel) {
      const auto id = cursor.take<std::uint16_t>();
      const auto schema = cursor.take<std::uint16_t>();
      channels_[id] = {std::string(cursor.take_text()), schemas_[schema]};
    } else if (record == McapRecord::message) {
      const auto& [topic, schema] = channels_[cursor.take<std::uint16_t>()];
      const bool is_image = topic == "/skin/raw" && schema == "sensor_msgs/msg/Image";
      if (!is_image && topic != "/skin/time") return;
      cursor.take<std::uint32_t>();  // the sequence number
      const auto logged_ns = cursor.take<std::uint64_t>();
      cursor.take<std::uint64_t>();  // when it was published
      cursor.take<std::uint32_t>();  // the encapsulation of CDR
      McapCursor cdr(cursor.take_bytes(cursor.left()), place_);
      const double stamp_s = cdr.take_stamp();
      cdr.take_text();  // the coordinate frame
      cdr.align_to_4();
      if (!is_image) {
        frame_time_ = {logged_ns, cdr.take_stamp()};
      } else {
        // The sensor's own time, if it came with the frame; else that of its arrival.
        times_s.push_back(frame_time_.first == logged_ns ? frame_time_.second : stamp_s);
        add_image(cdr);
      }
    }
  }

  void add_image(McapCursor& cdr) {
    const auto rows = cdr.take<std::uint32_t>();
    const auto cols = cdr.take<std::uint32_t>();
    const std::string_view encoding = cdr.take_text();  // ends in a zero
    cdr.take<std::uint8_t>();
    cdr.align_to_4();
    cdr.take<std::uint32_t>();  // bytes of a row
    const std::string_view image = cdr.take_text();
    using enum NumberType::Kind;
    const NumberType found = encoding.starts_with("mono8")    ? NumberType{unsigned_integer, 1}
                             : encoding.starts_with("mono16") ? NumberType{unsigned_integer, 2}
                                                              : NumberType{real, 4};
    if (times_s.size() == 1) {
      type = found;
      shape = {rows, cols};
    }
    if (shape != std::vector<std::uint64_t>{rows, cols} || type.bytes != found.bytes ||
        image.size() != shape[0] * shape[1] * type.bytes) {
      throw Error(place_,
                  fmt::format("frame {} is not {} x {} of {} as the first", times_s.size() - 1,
                              shape[0], shape[1], name_of(type)),
                  "record frames of one size in one file");
    }
    if (pixels.size() + image.size() > kMostInflatedBytes) {
      throw Error(place_, "holds more than 1 GiB of readings", "record them with --record FILE.h5");
    }
    const std::span<const std::byte> bytes = std::as_bytes(std::span(image));
    pixels.insert(pixels.end(), bytes.begin(), bytes.end());
  }

  /// Throws Error, naming the topics of a file without readings.
  [[noreturn]] void refuse() const {
    std::set<std::string> found;
    std::string first = "TOPIC";
    for (const auto& [id, channel] : channels_) {
      found.insert(fmt::format("{:.60} ({:.60})", channel.first, channel.second));
      const bool is_plain = channel.first.find_first_of("'\"\\$`!{}") == std::string::npos;
      if (is_plain && channel.second.ends_with("MultiArray")) first = channel.first;
    }
    const std::string code = fmt::format(
        "from mcap_ros2.reader import read_ros2_messages as r; "
        "np.save({{1}}, [m.ros_msg.data for m in r({{0}}, topics=['{}'])])",
        first);
    throw Error(place_,
                fmt::format("is an MCAP file without images of /skin/raw; it has {}",
                            fmt::join(found, ", ")),
                "pip install mcap-ros2-support, and " + python_line(code, file_.path()));
  }

  InputFile file_;
  std::string place_;
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, std::pair<std::string, std::string>> channels_;  // topic, schema
  std::pair<std::uint64_t, double> frame_time_;                            // when it was logged, s
  std::uint64_t inflated_bytes_ = 0;
};

std::unique_ptr<FileSource> open_mcap(const std::filesystem::path& path,
                                      const ReadOptions& options) {
  refuse_dataset(path, options);
  refuse_layout(path, options);
  McapReader file(path);
  ReadOptions known = options;
  known.axes = {ArrayAxis::frames, ArrayAxis::rows, ArrayAxis::columns};
  auto frames =
      array_in_memory(path.string(), file.type, {file.times_s.size(), file.shape[0], file.shape[1]},
                      std::move(file.pixels));
  return array_source(path, "MCAP of stream", std::move(frames), std::move(file.times_s), known);
}

}  // namespace

SourceFormat mcap_format() {
  return {.name = "MCAP of stream",
          .recognises = [](std::string_view head) { return head.starts_with(kMcapFileMagic); },
          .open = open_mcap};
}

}  // namespace pillarfield
