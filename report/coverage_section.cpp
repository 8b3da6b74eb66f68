// How often the stated uncertainty holds the truth.

#include <fmt/format.h>

#include <string>
#include <vector>

#include "report/section.h"
#include "report/table.h"
#include "tests/core/coverage_study.h"

namespace pillarfield::report {
namespace {

using coverage_study::Parted;
using coverage_study::Study;

constexpr const char* kIntroduction = R"(## Coverage

Beside each force stand the standard deviations of its components, and the ends of what an ambiguous force may be
([derivation](derivations/uncertainty.md)). Scenes with known truth say how often they hold it. The sensors have every imperfection
that a calibration knows: readings of whole counts (rounding adds a variance of 1/12), unequal sensels (10 %), tares, a
dead zone of 5 counts, and a threshold of four standard deviations of a reading. Regions are those that the status tells,
for a user has no other.

Share of the truths within ± 1.96 standard deviations, where 95 % are due, and between the ends, widened by three standard
deviations of noise, where all are:

)";

constexpr const char* kLuck = R"(
What moves the shares is selection. Near the threshold noise decides whether a sensel is usable. The share of truths held, all
components together, by what it did:

)";

constexpr const char* kEnd = R"(
Where a sensel is usable by luck its reading is too large by just that luck, and nine out of ten truths are held. One that is silent by
bad luck does no harm in region 2: the estimate without it is unbiased. Both are rare, so the regions keep their 95 %, less a few tenths
of a percent where forces are as small as dead zone and threshold.

In region 4 the ends miss some truths of the last scene. These are pillars that nothing touches: a threshold of four deviations
lets one idle sensel in 30,000 seem pressed, and more of those whose gain raises their noise, and a
sensel four deviations above nothing is not within three of it.
)";

std::string percent(double share) { return fmt::format("{:.1f} %", 100 * share); }

void add_regions(Table& table, const std::string& name, const Parted& parted) {
  for (const Region region : {Region::one, Region::two, Region::three, Region::four}) {
    const RegionCoverage c = parted.all.region(region);
    const bool determined = region == Region::one || region == Region::two;
    const auto band = [&](double share) { return determined ? percent(share) : "–"; };
    table.add({region == Region::one ? name : "", name_of(region), fmt::format("{}", c.pillars),
               band(c.shear_x), band(c.shear_y), band(c.normal),
               fmt::format("{:.2f} %", 100 * c.ends)});
  }
}

/// The share of a region's pillars that belong to a part, and how many of its truths are held.
std::vector<std::string> cells_of(const Coverage& part, const Coverage& all, Region region) {
  const RegionCoverage c = part.region(region);
  if (c.pillars == 0) return {"none", "–"};
  return {percent(static_cast<double>(c.pillars) / static_cast<double>(all.region(region).pillars)),
          percent((c.shear_x + c.shear_y + c.normal) / 3)};
}

void add_luck(Table& table, const std::string& name, const Parted& parted) {
  for (const Region region : {Region::one, Region::two}) {
    std::vector<std::string> cells = {region == Region::one ? name : "", name_of(region)};
    for (const Coverage* part : {&parted.rightly_read, &parted.by_luck, &parted.by_bad_luck}) {
      for (const std::string& cell : cells_of(*part, parted.all, region)) cells.push_back(cell);
    }
    table.add(cells);
  }
}

}  // namespace

std::string coverage_section(const Context& /*context*/) {
  Table regions("lrrrrrr",
                {"Scene", "region", "pillars", "shear_x", "shear_y", "normal", "between the ends"});
  Table luck("lrrrrrrr", {"Scene", "region", "as without noise", "held", "one usable by luck",
                          "held", "one silent by bad luck", "held"});
  for (const Study& study : coverage_study::studies()) {
    const Parted parted = coverage_study::cover(study.scene);
    add_regions(regions, study.name, parted);
    add_luck(luck, study.name, parted);
  }
  return kIntroduction + regions.text() + kLuck + luck.text() + kEnd;
}

}  // namespace pillarfield::report
