// Frames in the MCAP files that `stream --to FILE.mcap` writes: images of the topic /skin/raw.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/input_file.h"
#include "io/foreign_file.h"
#include "io/frame_source.h"
#include "io/plain/inflater.h"
#include "io/plain/source.h"
#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"

namespace pillarfield {
namespace {

constexpr std::string_view kMcapFileMagic = "\x89MCAP0\r\n";
constexpr std::string_view kReadingsTopic = "/skin/raw";
constexpr std::string_view kTimesTopic = "/skin/time";
constexpr std::string_view kImageType = "sensor_msgs/msg/Image";
constexpr const char* kDamagedMcap = "the file is damaged or truncated; use another copy";

/// Types of records (mcap.dev, version 0).
enum class McapRecord : std::uint8_t { schema = 3, channel = 4, message = 5, chunk = 6, end = 15 };
constexpr std::size_t kRecordHeadBytes = 9;  // type and length

/// Little-endian numbers and texts of bytes, one after another. Throws Error at their end.
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
    if (count > bytes_.size() - at_) throw Error(place_, "a record is cut off", kDamagedMcap);
    at_ += static_cast<std::size_t>(count);
    return bytes_.substr(at_ - static_cast<std::size_t>(count), static_cast<std::size_t>(count));
  }
  /// Skips to a multiple of `bytes` of a message of CDR.
  void align(std::size_t bytes) { take_bytes((bytes - at_ % bytes) % bytes); }
  [[nodiscard]] std::size_t at() const { return at_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }

 private:
  std::string_view bytes_;
  const std::string& place_;
  std::size_t at_ = 0;
};

/// Compressed messages in the file.
struct McapChunk {
  std::uint64_t at = 0;  ///< of the compressed bytes
  std::uint64_t bytes = 0;
  std::uint64_t inflated_bytes = 0;
  std::uint32_t checksum = 0;  ///< CRC-32 of the inflated bytes; 0: none
  bool is_compressed = false;
};

std::string inflated(const InputFile& file, const McapChunk& chunk) {
  std::string bytes = file.text_at(chunk.at, chunk.bytes);
  if (chunk.is_compressed) {
    std::string messages(chunk.inflated_bytes, '\0');
    const std::size_t found =
        ZSTD_decompress(messages.data(), messages.size(), bytes.data(), bytes.size());
    if (found != messages.size()) {
      throw Error(file.path().string(), "has a chunk of another size than it states", kDamagedMcap);
    }
    bytes = std::move(messages);
  }
  const uLong checksum = crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  if (bytes.size() == chunk.inflated_bytes && (chunk.checksum == 0 || checksum == chunk.checksum)) {
    return bytes;
  }
  throw Error(file.path().string(), "has a chunk that differs from its checksum", kDamagedMcap);
}

/// An image of readings, after the encapsulation of CDR.
struct McapImage {
  double time_s = 0;
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::string_view encoding;
  std::string_view pixels;
};

double take_stamp(McapCursor& cdr) {
  const auto seconds = cdr.take<std::int32_t>();
  return seconds + 1e-9 * cdr.take<std::uint32_t>();
}

McapImage take_image(McapCursor& cdr) {
  McapImage image;
  image.time_s = take_stamp(cdr);
  cdr.take_text();  // the coordinate frame
  cdr.align(4);
  image.rows = cdr.take<std::uint32_t>();
  image.cols = cdr.take<std::uint32_t>();
  image.encoding = cdr.take_text();
  image.encoding.remove_suffix(image.encoding.empty() ? 0 : 1);  // its zero
  cdr.take<std::uint8_t>();
  cdr.align(4);
  cdr.take<std::uint32_t>();  // bytes of a row
  image.pixels = cdr.take_text();
  return image;
}

std::optional<NumberType> type_of_pixels(std::string_view encoding) {
  using enum NumberType::Kind;
  if (encoding == "mono8") return NumberType{unsigned_integer, 1};
  if (encoding == "mono16") return NumberType{unsigned_integer, 2};
  if (encoding == "32FC1") return NumberType{real, 4};
  return std::nullopt;
}

/// Where the frames of a file are.
struct McapIndex {
  struct Frame {
    std::size_t chunk = 0;
    std::size_t at = 0;  ///< of the pixels in the inflated chunk
  };
  std::vector<McapChunk> chunks;
  std::vector<Frame> frames;
  std::vector<double> times_s;
  NumberType type;
  std::vector<std::uint64_t> shape;  ///< rows, columns
  bool is_cut = false;               ///< the file ends within a record
};

/// Reads a file from its beginning to its end, without the index that a killed writer leaves out.
class McapScan {
 public:
  explicit McapScan(const InputFile& file) : file_(file), place_(file.path().string()) {}

  McapIndex scan() {
    for (std::uint64_t at = kMcapFileMagic.size(); at < file_.size();) {
      const std::string head = file_.text_at(at, kRecordHeadBytes);
      if ((index_.is_cut = head.size() < kRecordHeadBytes)) break;
      McapCursor cursor(head, place_);
      const auto type = McapRecord{cursor.take<std::uint8_t>()};
      const auto bytes = cursor.take<std::uint64_t>();
      at += kRecordHeadBytes;
      if ((index_.is_cut = bytes > file_.size() - at)) break;
      if (type == McapRecord::end) break;
      if (type == McapRecord::chunk) {
        add_chunk(at, bytes);
      } else if (type == McapRecord::schema || type == McapRecord::channel) {
        constexpr std::uint64_t kLongest = 1U << 20U;
        add(type, file_.text_at(at, std::min(bytes, kLongest)), 0);
      }
      at += bytes;
    }
    if (index_.frames.empty()) refuse();
    return std::move(index_);
  }

 private:
  void add_chunk(std::uint64_t at, std::uint64_t bytes) {
    constexpr std::uint64_t kHeadBytes = 64;  // with the name of a compression
    if (is_interrupted()) throw Error(place_, "interrupted while it was read", "start again");
    const std::string head = file_.text_at(at, std::min(bytes, kHeadBytes));
    McapCursor cursor(head, place_);
    cursor.take_bytes(2 * sizeof(std::uint64_t));  // the first and the last time
    McapChunk chunk;
    chunk.inflated_bytes = cursor.take<std::uint64_t>();
    chunk.checksum = cursor.take<std::uint32_t>();
    const std::string_view compression = cursor.take_text();
    chunk.is_compressed = compression == "zstd";
    chunk.bytes = cursor.take<std::uint64_t>();
    chunk.at = at + cursor.at();
    if (!compression.empty() && !chunk.is_compressed) {
      throw Error(place_, fmt::format("its chunks are compressed by {:.20}", compression),
                  "write it with zstd: mcap compress --compression zstd");
    }
    inflated_bytes_ += chunk.inflated_bytes;
    if (chunk.bytes > bytes - cursor.at() || chunk.inflated_bytes > most_inflated(chunk.bytes) ||
        inflated_bytes_ > std::max(kLeastInMcap, kMostDeflateRatio * file_.size())) {
      throw Error(place_,
                  fmt::format("a chunk of {} bytes claims {}", chunk.bytes, chunk.inflated_bytes),
                  kDamagedMcap);
    }
    index_.chunks.push_back(chunk);
    const std::string messages = inflated(file_, chunk);
    McapCursor records(messages, place_);
    while (records.left() > 0) {
      const auto type = McapRecord{records.take<std::uint8_t>()};
      const auto length = records.take<std::uint64_t>();
      const std::size_t begin = records.at();
      add(type, records.take_bytes(length), begin);
    }
  }

  /// Adds a record whose content begins at `begin` of the inflated chunk.
  void add(McapRecord type, std::string_view content, std::size_t begin) {
    McapCursor cursor(content, place_);
    if (type == McapRecord::schema) {
      const auto id = cursor.take<std::uint16_t>();
      schemas_[id] = cursor.take_text();
    } else if (type == McapRecord::channel) {
      const auto id = cursor.take<std::uint16_t>();
      const auto schema = cursor.take<std::uint16_t>();
      channels_[id] = {std::string(cursor.take_text()), schemas_[schema]};
    } else if (type == McapRecord::message) {
      add_message(cursor, begin);
    }
  }

  void add_message(McapCursor& cursor, std::size_t begin) {
    constexpr std::size_t kEncapsulationBytes = 4;
    const auto channel = channels_.find(cursor.take<std::uint16_t>());
    if (channel == channels_.end()) return;
    const auto& [topic, schema] = channel->second;
    if (topic != kReadingsTopic && topic != kTimesTopic) return;
    cursor.take<std::uint32_t>();  // the sequence number
    const auto logged_ns = cursor.take<std::uint64_t>();
    cursor.take<std::uint64_t>();
    const std::string_view encapsulation = cursor.take_bytes(kEncapsulationBytes);
    if (encapsulation[1] != 1) throw Error(place_, "its messages are not little-endian CDR");
    const std::size_t at = begin + cursor.at();
    const std::string_view message = cursor.take_bytes(cursor.left());
    McapCursor cdr(message, place_);
    if (topic == kReadingsTopic && schema == kImageType) {
      const McapImage image = take_image(cdr);
      add_frame(image, logged_ns,
                at + static_cast<std::size_t>(image.pixels.data() - message.data()));
    } else if (topic == kTimesTopic) {
      take_stamp(cdr);
      cdr.take_text();
      cdr.align(4);
      frame_time_ = {logged_ns, take_stamp(cdr)};
    }
  }

  void add_frame(const McapImage& image, std::uint64_t logged_ns, std::size_t at) {
    const auto type = type_of_pixels(image.encoding);
    const std::vector<std::uint64_t> shape = {image.rows, image.cols};
    if (!type || image.pixels.size() / type->bytes != shape[0] * shape[1]) {
      throw Error(
          place_,
          fmt::format("frame {} claims {} x {} of {:.20} and has {} bytes", index_.frames.size(),
                      image.rows, image.cols, image.encoding, image.pixels.size()),
          kDamagedMcap);
    }
    if (index_.frames.empty()) {
      index_.type = *type;
      index_.shape = shape;
    } else if (shape != index_.shape || type->bytes != index_.type.bytes) {
      throw Error(place_,
                  fmt::format("frame {} is of another size or type than those before",
                              index_.frames.size()),
                  "record frames of one size in one file");
    }
    // The sensor's own time, if it came with the frame; else that of its arrival.
    const bool has_own = frame_time_ && frame_time_->first == logged_ns;
    index_.times_s.push_back(has_own ? frame_time_->second : image.time_s);
    index_.frames.push_back({index_.chunks.size() - 1, at});
  }

  /// Throws Error, naming the topics of a file without readings.
  [[noreturn]] void refuse() const {
    std::set<std::string> found;
    std::string first = "TOPIC";
    for (const auto& [id, channel] : channels_) {
      if (found.size() < 8)
        found.insert(fmt::format("{:.60} ({:.60})", channel.first, channel.second));
      const bool is_plain = channel.first.find_first_of("'\"\\$`!{}") == std::string::npos;
      if (is_plain && (first == "TOPIC" || channel.second.ends_with("MultiArray"))) {
        first = channel.first;
      }
    }
    throw Error(place_,
                found.empty() ? std::string("is an MCAP file without topics")
                              : fmt::format("is an MCAP file without images of {}; it has {}",
                                            kReadingsTopic, fmt::join(found, ", ")),
                "pip install mcap-ros2-support, and " +
                    python_line("import numpy as np; from mcap_ros2.reader import "
                                "read_ros2_messages; np.save({1}, [m.ros_msg.data for m in "
                                "read_ros2_messages({0}, topics=['" +
                                    first + "'])])",
                                file_.path()));
  }

  static constexpr std::uint64_t kLeastInMcap = std::uint64_t{2} << 30U;

  const InputFile& file_;
  std::string place_;
  McapIndex index_;
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, std::pair<std::string, std::string>> channels_;  // topic, schema
  std::optional<std::pair<std::uint64_t, double>> frame_time_;             // when it was logged, s
  std::uint64_t inflated_bytes_ = 0;
};

class McapFrames final : public NumberArray {
 public:
  McapFrames(InputFile file, McapIndex index)
      : NumberArray(file.path().string(), index.type,
                    {index.frames.size(), index.shape[0], index.shape[1]}),
        file_(std::move(file)),
        index_(std::move(index)) {}

  void read(std::uint64_t first, std::uint64_t count, std::byte* numbers) override {
    for (std::uint64_t i = first; i < first + count; ++i) {
      const McapIndex::Frame& frame = index_.frames[i];
      if (frame.chunk != open_chunk_) {
        messages_ = inflated(file_, index_.chunks[frame.chunk]);
        open_chunk_ = frame.chunk;
      }
      if (frame.at + slice_bytes() > messages_.size()) {
        throw Error(place(), "changed while it was read", "read it again");
      }
      std::memcpy(numbers, messages_.data() + frame.at, slice_bytes());
      numbers += slice_bytes();
    }
  }

 private:
  InputFile file_;
  McapIndex index_;
  std::string messages_;
  std::optional<std::size_t> open_chunk_;
};

std::unique_ptr<FileSource> open_mcap(const std::filesystem::path& path,
                                      const ReadOptions& options) {
  refuse_dataset(path, options);
  refuse_layout(path, options);
  InputFile file(path);
  McapIndex index = McapScan(file).scan();
  std::vector<double> times_s = std::move(index.times_s);
  const bool is_cut = index.is_cut;
  ReadOptions known = options;
  known.axes = {ArrayAxis::frames, ArrayAxis::rows, ArrayAxis::columns};
  auto source = array_source(path, "MCAP of stream",
                             std::make_unique<McapFrames>(std::move(file), std::move(index)),
                             std::move(times_s), known);
  if (is_cut) source->warn("The file was not finished; its whole chunks are read.");
  return source;
}

}  // namespace

SourceFormat mcap_format() {
  return {.name = "MCAP of stream",
          .recognises = [](std::string_view head) { return head.starts_with(kMcapFileMagic); },
          .open = open_mcap};
}

}  // namespace pillarfield
