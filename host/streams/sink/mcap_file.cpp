#include "streams/sink/mcap_file.h"

#include <fmt/format.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "pillarfield/error.h"
#include "pillarfield/version.h"

namespace pillarfield {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian");

constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";
constexpr std::string_view kCompression = "zstd";
constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

/// Types of records.
constexpr std::uint8_t kHeaderRecord = 0x01;
constexpr std::uint8_t kFooterRecord = 0x02;
constexpr std::uint8_t kSchemaRecord = 0x03;
constexpr std::uint8_t kChannelRecord = 0x04;
constexpr std::uint8_t kMessageRecord = 0x05;
constexpr std::uint8_t kChunkRecord = 0x06;
constexpr std::uint8_t kMessageIndexRecord = 0x07;
constexpr std::uint8_t kChunkIndexRecord = 0x08;
constexpr std::uint8_t kStatisticsRecord = 0x0B;
constexpr std::uint8_t kSummaryOffsetRecord = 0x0E;
constexpr std::uint8_t kDataEndRecord = 0x0F;

std::uint32_t crc_of(std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace

void McapBytes::put_text(std::string_view text) {
  put(static_cast<std::uint32_t>(text.size()));
  put_bytes(std::as_bytes(std::span(text)));
}

void McapBytes::put_bytes(std::span<const std::byte> bytes) {
  if (bytes.empty()) return;
  const std::size_t start = bytes_.size();
  bytes_.resize(start + bytes.size());
  std::memcpy(bytes_.data() + start, bytes.data(), bytes.size());
}

void McapBytes::put_record(std::uint8_t type, const McapBytes& content) {
  put(type);
  put(static_cast<std::uint64_t>(content.size()));
  put_bytes(content.view());
}

struct McapFile::Compressor {
  static constexpr int kLevel = 1;

  ZSTD_CCtx* context = ZSTD_createCCtx();
  Compressor() = default;
  ~Compressor() { ZSTD_freeCCtx(context); }
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;
};

void McapFile::TimeRange::include(std::uint64_t time_ns) {
  first = std::min(first, time_ns);
  last = std::max(last, time_ns);
}

McapFile::McapFile(const std::filesystem::path& path, std::span<const McapChannel> channels,
                   Replace replace)
    : file_(path, OutputKind::messages, replace), compressor_(std::make_unique<Compressor>()) {
  McapBytes header;
  header.put_text("ros2");
  header.put_text(fmt::format("pillarfield {}", kVersion));
  McapBytes start;
  start.put_bytes(std::as_bytes(std::span(kMcapMagic)));
  start.put_record(kHeaderRecord, header);
  put_channels(start, channels);
  write(start);
}

McapFile::~McapFile() {
  if (chunks_ > 0) file_.keep();
}

void McapFile::write(const McapBytes& bytes) {
  file_.write(bytes.view());
  size_ += bytes.size();
}

/// Puts the schemas and the channels, and remembers them for the summary.
void McapFile::put_channels(McapBytes& out, std::span<const McapChannel> channels) {
  std::map<std::string, std::uint16_t> ids;  // of schemas; 0 is none
  for (const McapChannel& channel : channels) {
    const auto next = static_cast<std::uint16_t>(ids.size() + 1);
    const auto [schema, is_new] = ids.try_emplace(channel.schema_name, next);
    McapBytes content;
    if (is_new) {
      content.put(schema->second);
      content.put_text(channel.schema_name);
      content.put_text("ros2msg");
      content.put_text(channel.schema);
      schemas_.put_record(kSchemaRecord, content);
      content.clear();
    }
    content.put(static_cast<std::uint16_t>(channel_count_++));
    content.put(schema->second);
    content.put_text(channel.topic);
    content.put_text("cdr");
    content.put_text("");  // no metadata
    channels_.put_record(kChannelRecord, content);
  }
  schema_count_ = ids.size();
  out.put_bytes(schemas_.view());
  out.put_bytes(channels_.view());
}

void McapFile::append(const Message& message) {
  constexpr std::size_t kFixedBytes = 22;
  chunk_index_[message.channel].emplace_back(message.time_ns, chunk_.size());
  chunk_times_.include(message.time_ns);
  chunk_.put(kMessageRecord);
  chunk_.put(static_cast<std::uint64_t>(kFixedBytes + message.bytes.size()));
  chunk_.put(message.channel);
  chunk_.put(message.sequence);
  chunk_.put(message.time_ns);
  chunk_.put(message.time_ns);
  chunk_.put_bytes(message.bytes);
  ++messages_[message.channel];
  times_.include(message.time_ns);
  if (chunk_.size() >= kChunkBytes) flush();
}

void McapFile::flush() {
  if (chunk_.size() == 0) return;
  const std::span<const std::byte> compressed = compressed_chunk();
  const std::uint64_t chunk_start = size_;
  write_chunk(compressed);
  write_indices(chunk_start, compressed.size());
  ++chunks_;
  chunk_.clear();
  chunk_times_ = {};
  for (auto& [channel, index] : chunk_index_) index.clear();
  file_.sync_at_intervals();
}

std::span<const std::byte> McapFile::compressed_chunk() {
  compressed_.resize(ZSTD_compressBound(chunk_.size()));
  const std::size_t bytes =
      ZSTD_compressCCtx(compressor_->context, compressed_.data(), compressed_.size(),
                        chunk_.view().data(), chunk_.size(), Compressor::kLevel);
  if (ZSTD_isError(bytes) != 0) {
    throw Error(file_.path().string(), ZSTD_getErrorName(bytes), "free memory");
  }
  return std::span(compressed_).first(bytes);
}

void McapFile::write_chunk(std::span<const std::byte> compressed) {
  McapBytes content;
  content.put(chunk_times_.first);
  content.put(chunk_times_.last);
  content.put(static_cast<std::uint64_t>(chunk_.size()));
  content.put(crc_of(chunk_.view()));
  content.put_text(kCompression);
  content.put(static_cast<std::uint64_t>(compressed.size()));
  content.put_bytes(compressed);
  McapBytes record;
  record.put_record(kChunkRecord, content);
  write(record);
}

/// Writes the message indices of the chunk, and remembers where everything is.
void McapFile::write_indices(std::uint64_t chunk_start, std::uint64_t compressed_bytes) {
  const std::uint64_t chunk_end = size_;
  McapBytes records;
  McapBytes offsets;
  for (const auto& [channel, index] : chunk_index_) {
    if (index.empty()) continue;
    offsets.put(channel);
    offsets.put(chunk_end + records.size());
    McapBytes content;
    content.put(channel);
    content.put(static_cast<std::uint32_t>(16 * index.size()));
    for (const auto& [time_ns, offset] : index) {
      content.put(time_ns);
      content.put(offset);
    }
    records.put_record(kMessageIndexRecord, content);
  }
  write(records);
  McapBytes content;
  content.put(chunk_times_.first);
  content.put(chunk_times_.last);
  content.put(chunk_start);
  content.put(chunk_end - chunk_start);
  content.put(static_cast<std::uint32_t>(offsets.size()));
  content.put_bytes(offsets.view());
  content.put(static_cast<std::uint64_t>(records.size()));
  content.put_text(kCompression);
  content.put(compressed_bytes);
  content.put(static_cast<std::uint64_t>(chunk_.size()));
  chunk_indices_.put_record(kChunkIndexRecord, content);
}

McapBytes McapFile::statistics() const {
  std::uint64_t total = 0;
  McapBytes counts;
  for (const auto& [channel, messages] : messages_) {
    total += messages;
    counts.put(channel);
    counts.put(messages);
  }
  McapBytes content;
  content.put(total);
  content.put(static_cast<std::uint16_t>(schema_count_));
  content.put(static_cast<std::uint32_t>(channel_count_));
  content.put(std::uint32_t{0});  // attachments
  content.put(std::uint32_t{0});  // metadata
  content.put(chunks_);
  content.put(total > 0 ? times_.first : 0);
  content.put(times_.last);
  content.put(static_cast<std::uint32_t>(counts.size()));
  content.put_bytes(counts.view());
  McapBytes record;
  record.put_record(kStatisticsRecord, content);
  return record;
}

void McapFile::finish() {
  flush();
  McapBytes no_crc;
  no_crc.put(std::uint32_t{0});
  McapBytes data_end;
  data_end.put_record(kDataEndRecord, no_crc);
  write(data_end);

  const std::uint64_t summary_start = size_;
  const McapBytes statistics_record = statistics();
  struct Group {
    std::uint8_t type;
    const McapBytes& records;
  };
  const std::array<Group, 4> groups = {{{kSchemaRecord, schemas_},
                                        {kChannelRecord, channels_},
                                        {kStatisticsRecord, statistics_record},
                                        {kChunkIndexRecord, chunk_indices_}}};
  McapBytes summary;
  McapBytes offsets;
  for (const Group& group : groups) {
    if (group.records.size() == 0) continue;
    McapBytes content;
    content.put(group.type);
    content.put(summary_start + summary.size());
    content.put(static_cast<std::uint64_t>(group.records.size()));
    offsets.put_record(kSummaryOffsetRecord, content);
    summary.put_bytes(group.records.view());
  }
  const std::uint64_t offsets_start = summary_start + summary.size();
  summary.put_bytes(offsets.view());
  constexpr std::uint64_t kFooterBytes = 20;
  summary.put(kFooterRecord);
  summary.put(kFooterBytes);
  summary.put(summary_start);
  summary.put(offsets_start);
  summary.put(crc_of(summary.view()));
  summary.put_bytes(std::as_bytes(std::span(kMcapMagic)));
  write(summary);
  file_.commit();
}

}  // namespace pillarfield
