# Writes a C++ file that holds page.html as bytes.
#   cmake -DPAGE=page.html -DOUTPUT=page.cpp -P EmbedPage.cmake
file(READ "${PAGE}" bytes HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
file(WRITE "${OUTPUT}" "#include <string_view>

namespace pillarfield {

std::string_view page_html();
std::string_view page_html() {
  static constexpr unsigned char kPage[] = {${bytes}};
  return {reinterpret_cast<const char*>(kPage), sizeof kPage};
}

}  // namespace pillarfield
")
