// Speed of the viewer's drawing.

#include <fmt/format.h>

#include "bench/cases/cases.h"
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

/// Times work on pictures, interleaved with clearing and reading back as many.
Measurement time_pictures(const Session& session, Pictures& pictures, const Work& work) {
  InterleavedTiming timing;
  const std::size_t candidate = timing.add(work);
  const std::size_t clear = timing.add([&](int count) { pictures.clear_and_read(count); });
  timing.run(session.length);
  Measurement measured;
  measured.seconds = timing.median(candidate);
  measured.counters["ms"] = measured.seconds * 1e3;
  // A software renderer draws in threads of this process.
  measured.counters["processor_ms"] = timing.processor_median(candidate) * 1e3;
  measured.counters["ns_per_pixel"] =
      measured.seconds * 1e9 / (double{Pictures::kWidth} * Pictures::kHeight);
  measured.counters["clear_and_read_ms"] = timing.median(clear) * 1e3;
  measured.counters["of_clear_and_read"] = timing.ratio(clear, candidate);
  measured.label = pictures.device_name();
  return measured;
}

Measurement time_drawing(const Session& session, const Pictures::Kind& kind) {
  Pictures pictures(session.device, kind);
  return time_pictures(session, pictures, [&](int count) { pictures.draw(count); });
}

Measurement time_reading(const Session& session) {
  Pictures pictures(session.device, {.pillars_a_side = kSides[0],
                                     .orbit = false,
                                     .arrows = true,
                                     .overlay = true,
                                     .in_place = false});
  return time_pictures(session, pictures, [&](int count) { pictures.read(count); });
}

}  // namespace

void add_render_cases(const Session& session) {
  for (const std::uint32_t side : kSides) {
    for (const bool orbit : {false, true}) {
      for (const NamedPicture& each : kPictures) {
        const Pictures::Kind kind{side, orbit, each.arrows, each.overlay, each.in_place};
        add_case(fmt::format("render/{}/{}/{}", side * side, orbit ? "orbit" : "top", each.name),
                 [&session, kind] { return time_drawing(session, kind); });
      }
    }
  }
  add_case("render/read_back", [&session] { return time_reading(session); });
}

}  // namespace pillarfield::bench
