#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "base/input_file.h"
#include "io/plain/inflater.h"
#include "io/plain/mat_file.h"

namespace pillarfield {

inline constexpr const char* kDamagedMat = "the file is damaged or truncated; use another copy";

/// Types of the elements of a MAT-file, miINT8 to miUTF32.
enum class MatType : std::uint32_t {
  int8 = 1,
  int32 = 5,
  uint32 = 6,
  matrix = 14,
  compressed = 15
};

/// What precedes an element.
struct MatTag {
  MatType type = {};
  std::uint64_t bytes = 0;
  bool is_small = false;             ///< its data are within the tag
  std::array<std::byte, 4> small{};  ///< those data
};

/// Reads a variable of a MAT-file from its first byte on, inflating it if it is compressed.
class MatReader {
 public:
  /// Inflates at most `budget` bytes, which it reduces. Both `file` and `budget` must outlive it.
  MatReader(const InputFile& file, const MatVariable& variable, bool is_swapped,
            std::uint64_t& budget);

  [[nodiscard]] std::uint64_t at() const { return at_; }  ///< bytes read and skipped
  void read(std::span<std::byte> bytes);
  void skip_to(std::uint64_t at);
  /// Inflates the rest, so that zlib verifies its checksum.
  void finish();

  [[nodiscard]] MatTag tag();
  /// The data of an element of that type after its tag. Throws Error if it is of another type or
  /// longer than `most` bytes.
  [[nodiscard]] std::string data(MatType type, std::uint64_t most);
  [[nodiscard]] std::uint32_t number(const char* bytes) const;  ///< of four bytes

  [[noreturn]] void fail(const std::string& failure) const;

 private:
  const InputFile& file_;
  MatVariable variable_;
  bool is_swapped_;
  std::uint64_t& budget_;
  std::optional<Inflater> inflater_;
  std::uint64_t at_ = 0;
};

}  // namespace pillarfield
