#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "viewer/source/shown_field.h"
#include "viewer/style/view.h"

namespace pillarfield::viewer {

/// Centres of pressure of contacts over the last seconds of the shown fields.
class Trails {
 public:
  static constexpr double kSeconds = 2;

  /// Adds the contacts of a field; without contacts, or after a step back, begins anew.
  void add(const ShownField& field);

  struct Place {
    double time_s;
    double x_mm, y_mm;  ///< from the middle of the skin, + right and up
  };
  struct Trail {
    std::uint64_t track_id;
    std::deque<Place> places;  ///< oldest first
  };
  [[nodiscard]] const std::vector<Trail>& all() const { return trails_; }

 private:
  void extend(std::uint64_t track_id, const Place& place);

  std::vector<Trail> trails_;
  double last_s_ = 0;
};

}  // namespace pillarfield::viewer
