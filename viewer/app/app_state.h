#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "viewer/source/player.h"
#include "viewer/source/selection.h"
#include "viewer/style/render_settings.h"

namespace pillarfield::viewer {

/// A clicked pillar and its history.
struct Pin {
  PillarIndex pillar;
  History history;
  int number = 0;  ///< 1..kMostPins, see number_pins(); 0: not yet numbered
};

/// Sums of a rectangle in one frame.
struct CachedSums {
  std::uint64_t frame;
  PillarRect rect;
  SelectionSums sums;
};

/// A dragged rectangle and the history of its total force.
struct Selection {
  PillarRect rect;
  History history;
  std::optional<CachedSums> cached = {};  ///< see selection_sums()
};

/// Measurements of drawing over about the last second.
struct DrawStatistics {
  double frames_hz = 0;
  double draw_ms_median = 0;     ///< from the begin of recording to the finished picture
  double latency_ms_median = 0;  ///< from the produced field to its presented picture
  bool in_place = false;         ///< the device reads the solver's memory without a copy
};

/// The state that panels show and actions change. Single-threaded.
struct AppState {
  Player* player = nullptr;
  RenderSettings settings;
  std::optional<ShownField> field;  ///< field on display
  std::optional<PillarIndex> hovered;
  std::vector<Pin> pins;  ///< at most kMostPins; the last is inspected
  std::optional<Selection> selection;
  DrawStatistics draw;
  bool show_help = false;
  bool show_panels = true;
  /// The last range of each quantity shown so far.
  std::array<std::optional<Range>, kQuantities> ranges;
  bool fit_each_field = false;     ///< fit the range to every field
  bool view_is_fitted = true;      ///< the view follows the window's size until the user moves it
  std::optional<View> other_view;  ///< the hidden one of top view and 3-D view
  bool writing = false;            ///< a FrameWriter is active
  std::string notice;              ///< one line about the last action: "wrote field.png"

  static constexpr std::size_t kMostPins = 6;
};

}  // namespace pillarfield::viewer
