#pragma once

namespace pillarfield::viewer {

/// Throws Error: all fields of the producer are in use.
[[noreturn]] void throw_too_many_shown();

}  // namespace pillarfield::viewer
