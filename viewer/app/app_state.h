#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "viewer/source/player.h"
#include "viewer/source/selection.h"
#include "viewer/style/render_settings.h"

namespace pillarfield::viewer {

/// A pillar that was clicked, and what it did since.
struct Pin {
  PillarIndex pillar;
  History history;
  int number = 0;  ///< 1..kMostPins on the field and in the panels, see number_pins(); 0: none yet
};

/// What a rectangle added up to in one frame.
struct CachedSums {
  std::uint64_t frame;
  PillarRect rect;
  SelectionSums sums;
};

/// A rectangle that was dragged, and what its sum did since.
struct Selection {
  PillarRect rect;
  History history;
  std::optional<CachedSums> kept = {};  ///< see selection_sums()
};

/// What was measured of drawing, lately (the last second or so).
struct DrawStatistics {
  double frames_hz = 0;
  double draw_ms_median = 0;     ///< from the begin of recording to the picture being there
  double latency_ms_median = 0;  ///< from a field being produced to its picture being presented
  bool in_place = false;         ///< the solver's memory is read without a copy
};

/// Everything that the window's panels show and change. One thread.
struct AppState {
  Player* player = nullptr;
  RenderSettings settings;
  std::optional<ShownField> field;  ///< the one on display
  std::optional<PillarIndex> hovered;
  std::vector<Pin> pins;  ///< kMostPins at most, the last one is inspected
  std::optional<Selection> region;
  DrawStatistics draw;
  bool show_help = false;
  bool show_panels = true;
  /// Ranges of the quantities that were looked at: each keeps its own.
  std::array<std::optional<Range>, kQuantities> ranges;
  bool fit_each_field = false;     ///< the range follows the field on display
  bool view_is_fitted = true;      ///< nobody moved the view: it follows the window's size
  std::optional<View> other_view;  ///< of top view and 3-D view the one not looked at
  bool writing = false;            ///< frames are being written to files
  std::string notice;              ///< one line about what was done last: "wrote field.png"

  static constexpr std::size_t kMostPins = 6;
};

}  // namespace pillarfield::viewer
