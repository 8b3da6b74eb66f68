// How fast the viewer draws.

#include <fmt/format.h>

#include "bench/cases/rows.h"
#include "bench/pictures.h"
#include "bench/timing/measurement.h"
#include "bench/variants.h"

namespace pillarfield::bench {
namespace {

/// 10 x 10 cm and a square metre.
constexpr std::uint32_t kSides[] = {79, kSquareMetre};

struct NamedPicture {
  const char* name;
  bool arrows;
  bool overlay;
  bool in_place;
};
constexpr NamedPicture kPictures[] = {{"heat", false, false, true},
                                      {"arrows", true, false, true},
                                      {"all", true, true, true},
                                      {"all_copied", true, true, false}};

/// Races work on pictures with clearing and reading back as many.
Measurement race_pictures(const Session& session, Pictures& pictures, const Work& work) {
  Race race;
  const std::size_t contestant = race.add(work);
  const std::size_t clear = race.add([&](int count) { pictures.clear_and_read(count); });
  race.run(session.length);
  Measurement measured;
  measured.seconds = race.median(contestant);
  measured.counters["ms"] = measured.seconds * 1e3;
  // A graphics device that is a program draws in this one's threads.
  measured.counters["processor_ms"] = race.processor_median(contestant) * 1e3;
  measured.counters["ns_per_pixel"] =
      measured.seconds * 1e9 / (double{Pictures::kWidth} * Pictures::kHeight);
  measured.counters["clear_and_read_ms"] = race.median(clear) * 1e3;
  measured.counters["of_clear_and_read"] = race.ratio(clear, contestant);
  measured.label = pictures.device_name();
  return measured;
}

Measurement race_drawing(const Session& session, const Pictures::Kind& kind) {
  Pictures pictures(session.device, kind);
  return race_pictures(session, pictures, [&](int count) { pictures.draw(count); });
}

Measurement race_reading(const Session& session) {
  Pictures pictures(session.device, {.pillars_a_side = kSides[0],
                                     .orbit = false,
                                     .arrows = true,
                                     .overlay = true,
                                     .in_place = false});
  return race_pictures(session, pictures, [&](int count) { pictures.read(count); });
}

}  // namespace

void add_render_rows(const Session& session) {
  for (const std::uint32_t side : kSides) {
    for (const bool orbit : {false, true}) {
      for (const NamedPicture& each : kPictures) {
        const Pictures::Kind kind{side, orbit, each.arrows, each.overlay, each.in_place};
        add_row(fmt::format("render/{}/{}/{}", side * side, orbit ? "orbit" : "top", each.name),
                [&session, kind] { return race_drawing(session, kind); });
      }
    }
  }
  add_row("render/read_back", [&session] { return race_reading(session); });
}

}  // namespace pillarfield::bench
