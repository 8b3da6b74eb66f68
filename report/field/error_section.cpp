// The error of region 3 by friction, body, motion and size.

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "report/field/section.h"
#include "report/table.h"
#include "testbed/gnuplot.h"

namespace pillarfield::report {
namespace {

using field_study::Indenter;
using field_study::Loading;

constexpr const char* kIntroduction = R"(## Error

RMS error in region 3, counts, by friction. "Noise alone" takes the nearest force to the truth among those that explain the readings.

)";

constexpr const char* kPicture = R"(
![Error against friction](pictures/field/error_by_friction.png)

*RMS error of the force vector in region 3 against friction, histories.*
)";

constexpr const char* kByBody = R"(
The same by body, motion and contact radius, for frictions up to 3. `contact` beats `paper` where its ratio is below 1.

)";

constexpr const char* kScript = R"(
set logscale xy
set xlabel 'friction coefficient'
set ylabel 'RMS error in region 3, counts'
set xtics (0.8, 1.2, 1.6, 2.2, 3.0, 4.5)
set ytics (0.5, 1, 2, 5, 10, 20)
set grid ytics linecolor '#dddddd'
set xrange [0.75 : 4.8]
set yrange [0.5 : 35]
set key outside right top Left reverse
)";

constexpr int kNotDrawn = 0;

/// A line of the table and of the picture.
struct Line {
  std::string name;
  int linetype;  ///< of gnuplot, or kNotDrawn
  std::function<field_study::Score(const std::vector<HistoryResult>&, double friction)> score;
};

std::vector<Line> lines() {
  const auto of_method = [](std::size_t method, int linetype) {
    return Line{methods()[method].name, linetype,
                [method](const std::vector<HistoryResult>& results, double friction) {
                  return pooled(results, method, of_friction(friction));
                }};
  };
  return {of_method(kDirect, 3),
          of_method(kLower, kNotDrawn),
          of_method(kMiddle, 6),
          of_method(kPaper, 7),
          of_method(kContact, 1),
          of_method(kUnrelated, 2),
          of_method(kGiven, 4),
          {"noise alone", 8, [](const std::vector<HistoryResult>& results, double friction) {
             return pooled_nearest(results, of_friction(friction));
           }}};
}

std::string friction_table(const std::vector<HistoryResult>& results) {
  std::vector<std::string> header = {""};
  std::vector<std::string> pillars = {"pillars of region 3"};
  for (const double friction : kFrictions) {
    header.push_back(fmt::format("µ {:.1f}", friction));
    pillars.push_back(fmt::format("{}", pooled_nearest(results, of_friction(friction)).open));
  }
  Table table("l" + std::string(kFrictions.size(), 'r'), header);
  for (const Line& line : lines()) {
    std::vector<std::string> cells = {line.name};
    for (const double friction : kFrictions)
      cells.push_back(rms_text(line.score(results, friction)));
    table.add(cells);
  }
  table.add(pillars);
  return table.text();
}

void draw_chart(const FieldContext& context) {
  std::string data = "$errors << END\n";
  std::string plot;
  int index = 0;
  for (const Line& line : lines()) {
    if (line.linetype == kNotDrawn) continue;
    std::string title = line.name;
    std::erase(title, '`');
    plot += fmt::format(
        "{} index {} using 1:2 with linespoints linetype {} pointtype 7 pointsize 0.6 title '{}'",
        index == 0 ? "plot $errors" : ", ''", index, line.linetype, title);
    ++index;
    for (const double friction : kFrictions) {
      data += fmt::format("{} {:.4f}\n", friction,
                          line.score(context.histories, friction).rms_counts());
    }
    data += "\n\n";
  }
  gnuplot::draw(context.docs / "pictures/field/error_by_friction",
                data + "END\n" + kScript + plot + "\n", {820, 420});
}

/// A row of all usual histories for which `holds`.
template <class Holds>
void add_row(const std::vector<HistoryResult>& results, const std::string& name, Holds holds,
             Table& table) {
  const auto usual = [&](const HistoryResult& result) {
    return result.history.friction <= kLargestUsual && holds(result.history);
  };
  std::vector<std::string> cells = {name};
  const auto recordings = std::count_if(results.begin(), results.end(), usual);
  cells.push_back(fmt::format("{}", recordings));
  cells.push_back(fmt::format("{}", pooled_nearest(results, usual).open));
  for (const std::size_t method : {kDirect, kPaper, kContact, kGiven}) {
    cells.push_back(rms_text(pooled(results, method, usual)));
  }
  const double paper = pooled(results, kPaper, usual).rms_counts();
  const double contact = pooled(results, kContact, usual).rms_counts();
  cells.push_back(paper > 0 ? fmt::format("{:.2f}", contact / paper) : "–");
  table.add(cells);
}

std::string body_table(const std::vector<HistoryResult>& results) {
  using field_study::History;
  Table table("lrrrrrrr", {"", "recordings", "pillars of region 3", "`direct`", "`paper`",
                           "`contact`", "friction given", "`contact` over `paper`"});
  for (int i = 0; i < field_study::kIndenters; ++i) {
    const auto indenter = static_cast<Indenter>(i);
    add_row(
        results, name_of(indenter),
        [=](const History& history) { return history.indenter == indenter; }, table);
  }
  for (int i = 0; i < field_study::kLoadings; ++i) {
    const auto loading = static_cast<Loading>(i);
    add_row(
        results, name_of(loading),
        [=](const History& history) { return history.loading == loading; }, table);
  }
  for (const double radius : {3, 5, 8, 12, 16, 22}) {
    add_row(
        results, fmt::format("radius of {} pillars", radius),
        [=](const History& history) { return history.radius_pillars == radius; }, table);
  }
  return table.text();
}

}  // namespace

std::string error_section(const FieldContext& context) {
  draw_chart(context);
  return kIntroduction + friction_table(context.histories) + kPicture + kByBody +
         body_table(context.histories);
}

}  // namespace pillarfield::report
