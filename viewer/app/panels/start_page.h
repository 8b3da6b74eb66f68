#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "viewer/style/colour_map.h"
#include "viewer/style/view.h"

namespace pillarfield::viewer {

/// What the start page offers.
struct StartChoices {
  std::vector<std::string> recent;
  std::vector<std::filesystem::path> scenes;
};

/// The page of a window without a source: recent sources, scenes, a line for the name of another.
/// Returns the source that was chosen; empty: none.
[[nodiscard]] std::string start_page(const StartChoices& choices, const Viewport& area,
                                     const std::string& notice, double scale);

/// What the window waits for while a source is opened.
void loading_page(const std::string& source, const std::string& message, const Viewport& area);

}  // namespace pillarfield::viewer
