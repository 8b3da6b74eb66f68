# Writes a C++ file that holds pictures of scenes as bytes.
#   cmake -DFOLDER=docs/pictures/gallery -DSCENES=demo,hand -DOUTPUT=pictures.cpp -P EmbedPictures.cmake
string(REPLACE "," ";" SCENES "${SCENES}")
set(arrays "")
set(entries "")
foreach(scene IN LISTS SCENES)
  file(READ "${FOLDER}/${scene}.png" bytes HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
  string(REPLACE "_" "" name "kPicture${scene}")
  string(APPEND arrays "constexpr unsigned char ${name}[] = {${bytes}};\n")
  string(APPEND entries "      EmbeddedPicture{\"${scene}\", ${name}},\n")
endforeach()
file(WRITE "${OUTPUT}" "#include \"viewer/app/source/start_pictures.h\"

namespace pillarfield::viewer {
namespace {
${arrays}
}  // namespace

std::span<const EmbeddedPicture> embedded_pictures() {
  static constexpr EmbeddedPicture kPictures[] = {
${entries}  };
  return kPictures;
}

}  // namespace pillarfield::viewer
")
