# Writes a C++ file whose function pillarfield::<FUNCTION>() returns the bytes of a file; of a list of
# kernel files, kernels/all.h, its directives, with each #include replaced by #line and the file.
#   cmake -DFILE=page.html -DFUNCTION=page_html -DOUTPUT=out.cpp -P Embed.cmake
if(FILE MATCHES "/all\\.h$")
  cmake_path(GET FILE PARENT_PATH folder)
  file(STRINGS "${FILE}" directives REGEX "^#")
  foreach(directive IN LISTS directives)
    set(text "")
    if(directive MATCHES "^#include \"(.*)\"")
      set(directive "#line 1 \"${CMAKE_MATCH_1}\"")
      file(READ "${folder}/${CMAKE_MATCH_1}" text HEX)
    endif()
    string(HEX "${directive}\n" line)
    string(APPEND bytes "${line}${text}")
  endforeach()
else()
  file(READ "${FILE}" bytes HEX)
endif()
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
file(WRITE "${OUTPUT}" "#include <string_view>

namespace pillarfield {

std::string_view ${FUNCTION}() {
  static constexpr unsigned char kBytes[] = {${bytes}};
  return {reinterpret_cast<const char*>(kBytes), sizeof kBytes};
}

}  // namespace pillarfield
")
