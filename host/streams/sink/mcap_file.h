#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pillarfield/output_file.h"

namespace pillarfield {

/// Bytes of MCAP: little-endian numbers, text and lists behind their length in bytes.
class McapBytes {
 public:
  template <class T>
  void put(T value) {
    put_bytes(std::as_bytes(std::span(&value, 1)));
  }
  void put_text(std::string_view text);
  void put_bytes(std::span<const std::byte> bytes);
  /// Appends a record: its type, its length and `content`.
  void put_record(std::uint8_t type, const McapBytes& content);

  void clear() { bytes_.clear(); }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[nodiscard]] std::span<const std::byte> view() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

/// A channel of an MCAP file. Channels with the same schema name share the schema.
struct McapChannel {
  std::string topic;
  std::string schema_name;
  std::string schema;  ///< ros2msg
};

/// Writes an MCAP file of ROS 2 messages in CDR (mcap.dev, version 0): messages in compressed
/// chunks, then an index.
///
/// Writes to `path` + ".part". After a kill, readers that need no index read all chunks that were
/// complete.
class McapFile {
 public:
  /// Channel i has the identifier i. Throws Error if the file cannot be written.
  McapFile(const std::filesystem::path& path, std::span<const McapChannel> channels,
           Replace replace);
  ~McapFile();
  McapFile(const McapFile&) = delete;
  McapFile& operator=(const McapFile&) = delete;

  struct Message {
    std::uint16_t channel = 0;
    std::uint32_t sequence = 0;
    std::uint64_t time_ns = 0;
    std::span<const std::byte> bytes;
  };
  /// Appends a message to the chunk, and writes the chunk if it is large. Throws Error if the disk
  /// is full.
  void append(const Message& message);

  /// Writes the chunk, if it has messages.
  void flush();

  /// Writes the chunk and the index, and renames the part.
  void finish();

 private:
  /// Times and places of the messages of a channel in the chunk.
  using MessageIndex = std::vector<std::pair<std::uint64_t, std::uint64_t>>;
  struct TimeRange {
    std::uint64_t first = UINT64_MAX;
    std::uint64_t last = 0;
    void include(std::uint64_t time_ns);
  };

  void write(const McapBytes& bytes);
  void put_channels(McapBytes& out, std::span<const McapChannel> channels);
  [[nodiscard]] std::span<const std::byte> compressed_chunk();
  void write_chunk(std::span<const std::byte> compressed);
  void write_indices(std::uint64_t chunk_start, std::uint64_t compressed_bytes);
  [[nodiscard]] McapBytes statistics() const;

  OutputFile file_;
  std::uint64_t size_ = 0;  // of the file
  McapBytes schemas_;
  McapBytes channels_;
  std::size_t schema_count_ = 0;
  std::size_t channel_count_ = 0;

  McapBytes chunk_;
  TimeRange chunk_times_;
  std::map<std::uint16_t, MessageIndex> chunk_index_;
  std::vector<std::byte> compressed_;
  struct Compressor;
  std::unique_ptr<Compressor> compressor_;

  McapBytes chunk_indices_;  // records of the summary
  std::uint32_t chunks_ = 0;
  TimeRange times_;
  std::map<std::uint16_t, std::uint64_t> messages_;  // of each channel
};

}  // namespace pillarfield
