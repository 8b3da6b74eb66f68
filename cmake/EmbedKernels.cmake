# Writes a C++ file that holds the kernel files as bytes, in the order given.
#   cmake -DFILES=a;b -DNAMES=a;b -DOUTPUT=out.cpp -P EmbedKernels.cmake
set(arrays "")
set(table "")
set(index 0)
foreach(file name IN ZIP_LISTS FILES NAMES)
  file(READ "${file}" bytes HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
  string(APPEND arrays "constexpr unsigned char kFile${index}[] = {${bytes}};\n")
  string(APPEND table "    {\"${name}\", as_text(kFile${index}, sizeof kFile${index})},\n")
  math(EXPR index "${index} + 1")
endforeach()
file(WRITE "${OUTPUT}" "#include \"device/kernel_files.h\"

namespace pillarfield {
namespace {

${arrays}
std::string_view as_text(const unsigned char* bytes, std::size_t size) {
  return {reinterpret_cast<const char*>(bytes), size};
}

}  // namespace

std::vector<KernelFile> kernel_files() {
  return {
${table}  };
}

}  // namespace pillarfield
")
