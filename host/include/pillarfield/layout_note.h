#pragma once

#include <string>

#include "pillarfield/skin.h"

namespace pillarfield {

/// The layout of frames that state none, and how to have the other one.
[[nodiscard]] std::string layout_note(const Skin& skin);

/// The constants of the skin that nothing states, and the options that do; empty: none.
[[nodiscard]] std::string assumption_note(const Skin& skin);

}  // namespace pillarfield
