#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "pillarfield/force_field.h"
#include "pillarfield/frame.h"

namespace pillarfield::viewer {

struct ShownContacts;

/// A field to look at. Its memory stays as it is for as long as a copy of it is alive; whoever made
/// it gets the memory back with the last one.
struct ShownField {
  ForceFieldView forces;
  FrameView raw;            ///< readings it was solved from; no data where they are not known
  double time_s = 0;        ///< of the frame, from its source
  std::uint64_t index = 0;  ///< of the frame in its source
  std::optional<double> direct_point = {};  ///< as component_ends() takes it
  /// Whole pages that hold all planes of `forces`, so that a graphics device may read them in
  /// place.
  std::span<const std::byte> pages;
  std::shared_ptr<const void> keep_alive;
  std::shared_ptr<const ShownContacts> contacts = {};  ///< none where they are not looked for
};

}  // namespace pillarfield::viewer
