# Writes a C++ file that holds the program of all.h as bytes: its directives, with each #include
# replaced by #line and the file.
#   cmake -DALL=kernels/all.h -DOUTPUT=out.cpp -P EmbedKernels.cmake
cmake_path(GET ALL PARENT_PATH folder)
file(STRINGS "${ALL}" directives REGEX "^#")
set(program "")
foreach(directive IN LISTS directives)
  set(text "")
  if(directive MATCHES "^#include \"(.*)\"")
    set(directive "#line 1 \"${CMAKE_MATCH_1}\"")
    file(READ "${folder}/${CMAKE_MATCH_1}" text HEX)
  endif()
  string(HEX "${directive}\n" line)
  string(APPEND program "${line}${text}")
endforeach()
string(REGEX REPLACE "(..)" "0x\\1," program "${program}")
file(WRITE "${OUTPUT}" "#include \"device/kernel_source.h\"

namespace pillarfield {
namespace {

constexpr unsigned char kProgram[] = {${program}};

}  // namespace

std::string_view kernel_program() {
  return {reinterpret_cast<const char*>(kProgram), sizeof kProgram};
}

}  // namespace pillarfield
")
