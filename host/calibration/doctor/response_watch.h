#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace pillarfield {

/// Rows or columns.
enum class LineAxis : std::uint8_t { rows, columns };

/// Tests sensels and lines by those on both sides of them, frame by frame: under one touch, what
/// lies between two loaded sensels is loaded. Memory: 32 bytes a sensel.
class ResponseWatch {
 public:
  /// `step`: distance of the sensels compared; 2 for pillars, whose shear unloads every second
  /// line.
  ResponseWatch(std::uint32_t rows, std::uint32_t cols, std::uint32_t step);

  /// Adds a frame: signals beyond rest, counts, and for each sensel the least that is a load. NaN:
  /// the sensel does not count.
  void add(std::span<const float> signals, std::span<const float> least);

  /// Rows or columns of which no sensel responds, while lines on both sides of them do at three
  /// places or more.
  [[nodiscard]] std::vector<std::uint32_t> dead_lines(LineAxis axis) const;
  /// Response of a line, relative to its neighbours.
  [[nodiscard]] double line_response(LineAxis axis, std::uint32_t line) const;

  /// Response of a sensel relative to the weaker of two opposite neighbours under the same touch;
  /// unset: not tested, or at one place only.
  [[nodiscard]] std::optional<double> response(std::size_t sensel) const;
  /// Standard deviation of it, of a noise in counts.
  [[nodiscard]] double deviation(std::size_t sensel, double noise) const;
  /// True if a load was seen on a sensel itself.
  [[nodiscard]] bool is_touched(std::size_t sensel) const { return sensels_[sensel].is_touched; }

 private:
  struct Sums {
    float products = 0;
    float squares = 0;
    float row = 0;  ///< centre of the first touch that tested it
    float col = 0;
    bool is_tested = false;  ///< at one place
    bool has_moved = false;  ///< at two
    bool is_touched = false;
  };
  /// Evidence against a line.
  struct Line {
    double response = 0;
    std::size_t places = 0;
    bool responds = false;
  };
  /// Responses of a sensel as part of a line, relative to the lines on both sides.
  struct Between {
    float products = 0;
    float squares = 0;
    bool more_before = false;  ///< some touch had more load on the line before
    bool more_behind = false;
  };

  void test_sensel(std::size_t row, std::size_t col);
  void test_between(std::size_t sensel, LineAxis axis, float before, float behind);
  void note_place(Sums& sums, std::size_t row, std::size_t col);
  [[nodiscard]] float at(std::size_t row, std::size_t col) const;
  [[nodiscard]] Line line(LineAxis axis, std::uint32_t number) const;

  std::uint32_t rows_;
  std::uint32_t cols_;
  std::uint32_t step_;
  std::span<const float> signals_;
  std::span<const float> least_;
  std::vector<Sums> sensels_;
  std::array<std::vector<Between>, 2> in_line_;  ///< of rows, of columns
};

}  // namespace pillarfield
