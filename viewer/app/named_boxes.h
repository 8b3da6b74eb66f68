#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pillarfield/skin.h"
#include "viewer/source/selection.h"

namespace pillarfield::viewer {

/// Sums of a rectangle in one frame.
struct CachedSums {
  std::uint64_t frame = 0;
  PillarRect rect;
  SelectionSums sums;
};

/// A rectangle of pillars that the user named.
struct NamedBox {
  std::string name;  ///< printable, 1..kMostNameBytes bytes of UTF-8
  PillarRect rect;   ///< inside the skin
  int number = 1;    ///< from 1, of its colour
  std::optional<CachedSums> cached = {};

  static constexpr std::size_t kMostNameBytes = 31;
  friend bool operator==(const NamedBox& a, const NamedBox& b) {
    return a.name == b.name && a.rect == b.rect;
  }
};

/// True for a name that a box may have.
[[nodiscard]] bool is_box_name(std::string_view name);

/// The named boxes of each size of skin, in elements, and layout.
class NamedBoxes {
 public:
  static constexpr std::size_t kMost = 16;       ///< on one size of skin
  static constexpr std::size_t kMostSizes = 16;  ///< the sizes set last

  /// Boxes on skins of this size, numbered from 1.
  [[nodiscard]] std::vector<NamedBox> on(const Skin& skin) const;
  void set(const Skin& skin, std::vector<NamedBox> boxes);

  /// One line "box ROWS COLS LAYOUT ROW_BEGIN ROW_END COL_BEGIN COL_END NAME" for each box.
  [[nodiscard]] std::string text() const;
  /// Adds the box of such a line; ignores another line, a box beyond the limits or its skin.
  void add_line(const std::string& line);

 private:
  struct Size {
    std::uint32_t rows = 0, cols = 0;
    SkinLayout layout = SkinLayout::pillars;
    friend bool operator==(const Size&, const Size&) = default;
  };
  struct Sized {
    Size size;
    std::vector<NamedBox> boxes;
  };
  static Size size_of(const Skin& skin);

  std::vector<Sized> sizes_;  ///< the one set last is the first
};

}  // namespace pillarfield::viewer
