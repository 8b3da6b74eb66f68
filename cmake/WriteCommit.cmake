# cmake -D SOURCE=folder -D OUTPUT=commit.h -P WriteCommit.cmake: writes the commit of SOURCE, only when
# it has changed.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=10
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit "unknown")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[#pragma once

namespace pillarfield::cli {

inline constexpr const char* kCommit = "@commit@";

}  // namespace pillarfield::cli
]] @ONLY)
