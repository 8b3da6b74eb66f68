#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pillarfield {

/// Similarities of lines, [line, line], in 0..1.
class LineSimilarities {
 public:
  explicit LineSimilarities(std::size_t lines) : lines_(lines), values_(lines * lines) {}

  [[nodiscard]] std::size_t lines() const { return lines_; }
  [[nodiscard]] double operator()(std::size_t a, std::size_t b) const {
    return values_[a * lines_ + b];
  }
  void set(std::size_t a, std::size_t b, double value) {
    values_[a * lines_ + b] = value;
    values_[b * lines_ + a] = value;
  }

 private:
  std::size_t lines_;
  std::vector<double> values_;
};

using LinePath = std::vector<std::uint32_t>;

/// The sum of the similarities of lines that are neighbours in a path.
[[nodiscard]] double sum_along(const LineSimilarities& similar, const LinePath& path);

/// The path through all lines with a large sum: the best of those that grow from each of some
/// lines, and of 0, 1, 2 ..., after reversing and moving parts as long as that helps. Of several
/// paths of nearly that sum, one near to 0, 1, 2 ...
[[nodiscard]] LinePath find_path(const LineSimilarities& similar);

}  // namespace pillarfield
