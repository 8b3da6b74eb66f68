#include <algorithm>

#include "viewer/source/selection.h"

namespace pillarfield::viewer {

History::History(std::size_t capacity) : capacity_(std::max<std::size_t>(capacity, 1)) {}

void History::add(const Point& point) {
  while (!points_.empty() && points_.back().time_s >= point.time_s) points_.pop_back();
  if (points_.size() == capacity_) points_.pop_front();
  points_.push_back(point);
}

void History::clear() { points_.clear(); }

}  // namespace pillarfield::viewer
