#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "viewer/app/panels/plot.h"
#include "viewer/app/source/loaded_source.h"
#include "viewer/source/selection.h"

namespace pillarfield::viewer {

/// One line about the last action: "wrote field.png".
class Notice : public std::string {
 public:
  Notice& operator=(const std::string& words) {
    assign(words);
    is_failure = false;
    return *this;
  }
  void fail(const std::string& words) {
    assign(words);
    is_failure = true;
  }

  bool is_failure = false;  ///< drawn in the colour of warnings
};

/// A clicked pillar.
struct Pin {
  PillarIndex pillar;
  int number = 0;  ///< 1..kMostPins, see number_pins(); 0: not yet numbered
};

/// The look of the picture.
struct ShownLook {
  RenderSettings settings;
  /// The last range of each quantity shown so far.
  std::array<std::optional<Range>, kQuantities> ranges;
  bool fit_each_field = false;     ///< fit the range to every field
  bool view_is_fitted = true;      ///< the view follows the window's size until the user moves it
  std::optional<View> other_view;  ///< the hidden one of top view and 3-D view
  TimeWindow time_window;          ///< of the curves
};

/// Marks on the skin.
struct Marks {
  static constexpr std::size_t kMostPins = 6;

  std::optional<PillarIndex> hovered;
  std::vector<Pin> pins;  ///< at most kMostPins; the last is inspected
};

/// The window around the picture.
struct WindowState {
  bool show_help = false;
  Viewport help_place;  ///< in the window, pixels
  bool show_panels = true;
  bool folds_curves = false;
  bool writing = false;  ///< all frames are being written
  Notice notice;
};

/// The state that panels show and actions change. Single-threaded.
struct AppState {
  ShownSource source;
  ShownLook look;
  Marks marks;
  WindowState window;
};

}  // namespace pillarfield::viewer
