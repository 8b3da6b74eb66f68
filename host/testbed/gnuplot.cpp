#include "testbed/gnuplot.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>

#include "base/child_program.h"
#include "pillarfield/error.h"

namespace pillarfield::gnuplot {
namespace {

constexpr const char* kStyle = R"(
set encoding utf8
set minussign
set border 3 linecolor '#444444' linewidth 1
set tics out nomirror textcolor '#000000'
set key noautotitle samplen 2 spacing 1.2
set style fill solid noborder
set linetype 1 linecolor '#000000' linewidth 2 pointtype 6
set linetype 2 linecolor '#E69F00' linewidth 2 pointtype 5
set linetype 3 linecolor '#56B4E9' linewidth 2 pointtype 9
set linetype 4 linecolor '#009E73' linewidth 2 pointtype 13
set linetype 5 linecolor '#F0E442' linewidth 2 pointtype 11
set linetype 6 linecolor '#0072B2' linewidth 2 pointtype 7
set linetype 7 linecolor '#D55E00' linewidth 2 pointtype 4
set linetype 8 linecolor '#CC79A7' linewidth 2 pointtype 15
)";

/// A picture format.
struct Format {
  const char* ending;
  std::string terminal;       ///< gnuplot's command
  std::string_view end_mark;  ///< among the last bytes of a complete file
};

Format svg_format(Size size) {
  return {".svg",
          fmt::format("set terminal svg enhanced size {},{} dynamic font 'sans-serif,14' "
                      "background '#ffffff'\n",
                      size.width_px, size.height_px),
          "</svg>"};
}

Format png_format(Size size) {
  return {".png",
          fmt::format("set terminal pngcairo enhanced size {},{} font 'sans-serif,13' fontscale 2 "
                      "linewidth 2 pointscale 2.6 background '#ffffff'\n",
                      2 * size.width_px, 2 * size.height_px),
          "IEND"};
}

/// Returns the error of gnuplot in one line, or nothing. A warning means skipped data; the last
/// line of a failure is its reason.
std::string error_in(const std::string& messages, bool failed) {
  std::istringstream lines(messages);
  std::string last = "unknown reason";
  for (std::string line; std::getline(lines, line);) {
    line.erase(0, line.find_first_not_of(' '));
    if (line.find("warning:") != std::string::npos) return line;
    if (!line.empty()) last = line;
  }
  return failed ? last : "";
}

/// Whether the file is complete; gnuplot does not report a full disk.
bool is_complete(const OutputFile& file, std::string_view end_mark) {
  std::array<char, 16> tail{};
  const off_t end = lseek(file.descriptor(), 0, SEEK_END);
  const off_t begin = std::max<off_t>(end - static_cast<off_t>(tail.size()), 0);
  const ssize_t got = pread(file.descriptor(), tail.data(), tail.size(), begin);
  if (got <= 0) return false;
  const std::string_view text(tail.data(), static_cast<std::size_t>(got));
  return text.find(end_mark) != std::string_view::npos;
}

void run(const Format& format, const std::string& script, const OutputFile& output) {
  ChildProgram gnuplot({"gnuplot", "--default-settings"},  // ignores ~/.gnuplot
                       "install it; its Debian package is gnuplot-nox", output.descriptor());
  const bool fed = gnuplot.feed(format.terminal + kStyle + script);
  const bool done = gnuplot.finish() && fed;
  const std::string error = error_in(gnuplot.errors(), !done);
  if (!error.empty()) {
    throw Error(output.path().string(), "gnuplot failed: " + error, "use gnuplot 5.4 or later");
  }
  if (!is_complete(output, format.end_mark)) {
    throw Error(output.path().string(), "gnuplot did not write the whole file",
                "free space on that disk");
  }
}

}  // namespace

void draw(const std::filesystem::path& stem, const std::string& script, Size size,
          Replace replace) {
  const Format svg = svg_format(size);
  const Format png = png_format(size);
  OutputFile svg_file(stem.string() + svg.ending, OutputKind::svg, replace);
  OutputFile png_file(stem.string() + png.ending, OutputKind::png, replace);
  run(svg, script, svg_file);
  run(png, script, png_file);
  svg_file.commit();
  png_file.commit();
}

}  // namespace pillarfield::gnuplot
