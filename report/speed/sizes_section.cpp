// What a pillar costs by the size of the skin and by how much of it is touched.

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "report/speed/section.h"
#include "report/table.h"
#include "testbed/gnuplot.h"

namespace pillarfield::report {
namespace {

constexpr const char* kSizes = R"(## Cost against size and contact

![Time per pillar against the size of the skin and the share in contact](pictures/performance/size_and_contact.png)

*Left: the bare solve, its copy and the loop vectorised by hand, all threads, in one race for each size. Right: a square metre of which eight
round contacts cover a share, which move from frame to frame. Dashed: the copies of the same bytes.*

Small skins cost what starting a kernel does. From 10⁶ pillars on frames and results come from memory and go there.

)";

constexpr const char* kContact = R"(
A block of pillars that is silent, and was silent when its place in the result was last written, need not be written again.

)";

constexpr const char* kScript = R"(
set multiplot layout 1,2 margins 0.1, 0.98, 0.2, 0.96 spacing 0.11
set logscale xy
set ylabel 'ns per pillar'
set xlabel 'pillars'
set xtics ('10^3' 1e3, '10^4' 1e4, '10^5' 1e5, '10^6' 1e6, '10^7' 1e7)
set xrange [7e2 : 1.5e7]
set ytics (0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200)
set key top right
plot $sizes using 1:3 with linespoints linetype 1 dashtype 2 linewidth 1.5 pointtype 6 \
       pointsize 0.6 title 'copy', \
     '' using 1:4 with linespoints linetype 2 pointtype 5 pointsize 0.6 title 'by hand', \
     '' using 1:2 with linespoints linetype 6 pointtype 7 pointsize 0.7 title 'ours'
set xlabel 'share of the skin in contact (%)'
set xtics (0.1, 1, 10, 100)
set xrange [0.07 : 140]
set key top left Left reverse
set yrange [0.7 * least : 8 * most]
plot $contact using 1:5 with linespoints linetype 7 dashtype 2 linewidth 1.5 pointtype 4 \
       pointsize 0.6 title 'copy, all stages', \
     '' using 1:4 with linespoints linetype 7 pointtype 5 pointsize 0.6 title 'all stages', \
     '' using 1:3 with linespoints linetype 6 dashtype 2 linewidth 1.5 pointtype 6 \
       pointsize 0.6 title 'copy, bare', \
     '' using 1:2 with linespoints linetype 6 pointtype 7 pointsize 0.7 title 'bare'
unset multiplot
)";

constexpr const char* kContactShares[] = {"0.1", "1", "10", "100"};

struct Size {
  double pillars = 0;
  double ours = 0;  ///< ns per pillar
  double copy = 0;
  std::optional<double> by_hand;
  double of_ceiling = 0;
};

/// From the races with the loop by hand, or without it where the processor has none.
std::vector<Size> sizes_of(const BenchRun& bench) {
  std::vector<Size> sizes;
  for (const std::string& row : bench.rows_of("by_hand")) {
    const bool raced = bench.why_left_out(row).empty();
    const std::string ours = raced ? row : "size" + row.substr(row.find('/'));
    Size size;
    size.pillars = bench.value(ours, "pillars");
    size.ours = bench.value(ours, raced ? "our_ns_per_pillar" : "ns_per_pillar");
    size.by_hand = bench.find(row, "ns_per_pillar");
    size.of_ceiling = bench.value(ours, "of_ceiling");
    size.copy = size.ours * size.of_ceiling;
    sizes.push_back(size);
  }
  return sizes;
}

struct ContactCost {
  std::string percent;
  double time = 0;  ///< ns per pillar
  double copy = 0;
};

std::vector<ContactCost> contact_costs(const BenchRun& bench, const std::string& what) {
  std::vector<ContactCost> costs;
  for (const std::string percent : kContactShares) {
    const std::string row = fmt::format("contact/{}/{}", percent, what);
    const double time = bench.value(row, "ns_per_pillar");
    costs.push_back({percent, time, time * bench.value(row, "of_ceiling")});
  }
  return costs;
}

void draw(const std::filesystem::path& stem, const std::vector<Size>& sizes,
          const std::vector<ContactCost>& bare, const std::vector<ContactCost>& all) {
  std::string data = "$sizes << END\n";
  for (const Size& size : sizes) {
    data += fmt::format("{} {} {} {}\n", size.pillars, size.ours, size.copy,
                        size.by_hand ? fmt::format("{}", *size.by_hand) : "NaN");
  }
  data += "END\n$contact << END\n";
  for (std::size_t i = 0; i < bare.size(); ++i) {
    data += fmt::format("{} {} {} {} {}\n", bare[i].percent, bare[i].time, bare[i].copy,
                        all[i].time, all[i].copy);
  }
  // Room for the key above the lines.
  const auto range = [](const std::vector<ContactCost>& costs) {
    return std::ranges::minmax(costs, {}, &ContactCost::time);
  };
  data += fmt::format("END\nleast = {}\nmost = {}\n", range(bare).min.time, range(all).max.time);
  gnuplot::draw(stem, data + kScript, {960, 400});
}

std::string sizes_table(const std::vector<Size>& sizes) {
  Table table("rrrrrr", {"Pillars", "ns per pillar", "copy", "by hand", "share of the ceiling",
                         "by hand over ours"});
  for (const Size& size : sizes) {
    const auto text = [](double value) { return fmt::format("{:.3g}", value); };
    table.add({fmt::format("{:.0f}", size.pillars), text(size.ours), text(size.copy),
               size.by_hand ? text(*size.by_hand) : "unmeasured",
               fmt::format("{:.2f}", size.of_ceiling),
               size.by_hand ? fmt::format("{:.2f}", *size.by_hand / size.ours) : "–"});
  }
  return table.text();
}

/// Times are taken over the copies of the same bytes, which a race has, before they are compared.
std::string contact_table(const std::vector<ContactCost>& bare,
                          const std::vector<ContactCost>& all) {
  Table table("rrrrr", {"In contact", "bare, ns per pillar", "over 100 %",
                        "all stages, ns per pillar", "over 100 %"});
  const auto relative = [](const ContactCost& cost, const ContactCost& whole) {
    return fmt::format("{:.3f}", (cost.time / cost.copy) / (whole.time / whole.copy));
  };
  for (std::size_t i = 0; i < bare.size(); ++i) {
    table.add({bare[i].percent + " %", fmt::format("{:.3g}", bare[i].time),
               relative(bare[i], bare.back()), fmt::format("{:.3g}", all[i].time),
               relative(all[i], all.back())});
  }
  return table.text();
}

}  // namespace

std::string sizes_section(const SpeedContext& context) {
  const BenchRun& bench = context.run.bench;
  const std::vector<Size> sizes = sizes_of(bench);
  const std::vector<ContactCost> bare = contact_costs(bench, "bare");
  const std::vector<ContactCost> all = contact_costs(bench, "all");
  draw(context.docs / "pictures/performance/size_and_contact", sizes, bare, all);
  return kSizes + sizes_table(sizes) + kContact + contact_table(bare, all);
}

}  // namespace pillarfield::report
