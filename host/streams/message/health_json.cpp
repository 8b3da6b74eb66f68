#include "streams/message/health_json.h"

namespace pillarfield {

nlohmann::ordered_json health_json(const HealthReport& health) {
  const StreamHealth& stream = health.stream;
  return {
      {"rate_hz", stream.rate_hz},
      {"frames", stream.frames},
      {"solved", health.solved},
      {"lost", stream.lost},
      {"incomplete", stream.incomplete},
      {"late", stream.late},
      {"duplicates", stream.duplicates},
      {"reordered", stream.reordered},
      {"invalid", stream.invalid},
      {"restarts", stream.restarts},
      {"clock_jumps", stream.clock_jumps},
      {"overrun", stream.overrun},
      {"since_frame_s", health.since_frame_s},
      {"latency_ms", {{"median", health.latency_ms_median}, {"worst", health.latency_ms_worst}}},
      {"sensels", {{"dead", health.dead}, {"stuck", health.stuck}, {"drifting", health.drifting}}},
      {"coverage", health.coverage}};
}

}  // namespace pillarfield
