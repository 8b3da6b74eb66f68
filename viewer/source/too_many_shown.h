#pragma once

namespace pillarfield::viewer {

/// Throws the Error of a producer whose fields are all in use.
[[noreturn]] void throw_too_many_shown();

}  // namespace pillarfield::viewer
