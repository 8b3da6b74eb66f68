# Writes a C++ file that holds page.html as bytes.
#   cmake -DPAGE=page.html -DOUTPUT=page.cpp -P EmbedPage.cmake
file(READ "${PAGE}" bytes HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
file(WRITE "${OUTPUT}" "#include \"streams/sink/page.h\"

namespace pillarfield {
namespace {

constexpr unsigned char kPage[] = {${bytes}};

}  // namespace

std::string_view page_html() { return {reinterpret_cast<const char*>(kPage), sizeof kPage}; }

}  // namespace pillarfield
")
