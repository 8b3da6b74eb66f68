#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "streams/source/byte_parser.h"

namespace pillarfield {

/// Finds the frames of a FlexiTac board in a stream of bytes: the marks 0xAA 0x55 and rows x cols
/// readings of 8 bits, row by row, one frame right after the other, without number and checksum.
/// Each becomes a packet.
///
/// Readings may look like marks. So the unit of evidence is a *chain*, marks that lie one frame
/// apart each, and a frame is taken only if it lies between two marks of a chain to which there is
/// no alternative:
/// - A chain is that of the frames once its last frame has no other mark in it and no other chain
///   ended there, or once it has more than kProof marks while there is no other chain and none
///   ended.
/// - From then on a frame is taken with the mark after it, unless a chain begins within it: that of
///   the frames after a loss of bytes, or readings. It waits until that chain ends, or has kProof
///   marks, as readings that stand still have. If another chain ended meanwhile, as it does where
///   bytes are lost, or the chain of the frames is hardly older, nothing tells the two apart, and
///   the frame is not taken.
/// - If a mark fails to come, the search starts again.
///
/// The cost is a few instructions a byte, and memory for kProof + 1 frames.
class FlexitacParser final : public ByteParser {
 public:
  /// `shape` is of readings of 8 bits.
  explicit FlexitacParser(const FrameShape& shape);

  void prepare(const FrameShape& /*shape*/) override {}
  [[nodiscard]] std::span<std::byte> space() override;
  void commit(std::size_t bytes, std::chrono::nanoseconds arrived) override;
  bool next(Packet& packet) override;
  void finish() override;
  [[nodiscard]] std::uint64_t invalid() const override { return invalid_; }
  [[nodiscard]] std::string complaint() const override;

  static constexpr std::uint8_t kProof = 4;
  static constexpr std::size_t kMarkBytes = 2;
  /// True if the two bytes are the marks of a frame.
  static bool is_mark(const std::byte* bytes) {
    return bytes[0] == std::byte{0xAA} && bytes[1] == std::byte{0x55};
  }

 private:
  /// Bytes that arrived together.
  struct Read {
    std::uint64_t end = 0;
    std::chrono::nanoseconds arrived{0};
  };

  void look_at(std::uint64_t place);
  void measure_spacing(std::uint64_t mark);
  void find_step(std::uint64_t mark, std::uint8_t marks);
  void release(std::uint64_t mark);
  void lose_step(std::uint64_t place);
  void count_rubbish();
  void take_frame(Packet& packet);

  FrameShape shape_;
  std::uint64_t frame_bytes_;  ///< of marks and readings
  std::vector<std::byte> buffer_;
  std::vector<Read> reads_;  ///< of the bytes in the buffer

  // Places are counted in bytes from the begin of the stream.
  std::uint64_t begin_ = 0;   ///< of the buffer
  std::uint64_t end_ = 0;     ///< of the bytes in it
  std::uint64_t looked_ = 0;  ///< the first place that was not looked at
  std::uint64_t taken_ = 0;   ///< end of the last frame taken

  /// By place modulo frame_bytes_: marks of the chain that is there, at most kProof + 1.
  std::vector<std::uint8_t> chains_;
  std::optional<std::uint64_t> last_mark_;
  std::optional<std::uint64_t> last_link_;  ///< mark of a chain that has two or more
  std::uint64_t clean_since_ = 0;           ///< no chain of two marks or more ended from here on

  std::optional<std::uint64_t> step_since_;  ///< where the chain of the frames was found; or not
  std::uint64_t next_ = 0;                   ///< where its next mark must be
  std::uint64_t held_ = 0;                   ///< frames before its last mark that are not taken
  std::uint64_t ready_ = 0;                  ///< of these, how many of the oldest may be

  std::uint64_t spacing_ = 0;   ///< between the last two marks
  std::uint64_t spacings_ = 0;  ///< how often it was that

  std::optional<std::chrono::nanoseconds> opened_;  ///< arrival of the first bytes
  bool has_settled_ = false;                        ///< the last frame came later than that
  std::uint64_t sequence_ = 0;                      ///< of the next frame
  bool in_rubbish_ = false;
  std::uint64_t invalid_ = 0;
};

}  // namespace pillarfield
