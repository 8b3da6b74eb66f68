#include "calibration/doctor/diagnosis_facts.h"

#include <optional>

namespace pillarfield {
namespace {

using Json = nlohmann::ordered_json;

Json fact_of(const SenselFigure& figure) {
  return {{"median", figure.median}, {"worst", figure.worst}, {"place", figure.place}};
}

template <class Number>
Json fact_of(const std::optional<Number>& number) {
  return number ? Json(*number) : Json(nullptr);
}

Json fact_of(const ArrayFinding& finding) {
  Json facts = {{"fault", name_of(finding.fault)}};
  if (!finding.sensels.empty()) {
    facts["count"] = finding.sensels.size();
    facts["sensels"] = finding.sensels;
  }
  if (!finding.lines.empty()) facts["lines"] = finding.lines;
  facts["figure"] = finding.figure;
  facts["text"] = finding.text;
  return facts;
}

}  // namespace

nlohmann::ordered_json facts_of(const Diagnosis& found) {
  Json gaps = Json::array();
  for (const FrameGap& gap : found.timing.gaps) {
    gaps.push_back({{"frame", gap.frame}, {"time_s", gap.time_s}, {"length_s", gap.length_s}});
  }
  Json facts = {{"frames", found.frames},
                {"frames_looked_at", found.kept},
                {"rows", found.rows},
                {"cols", found.cols},
                {"sensel_type", name_of(found.type)},
                {"rate_hz", fact_of(found.timing.rate_hz)},
                {"jitter_ms", found.timing.jitter_ms},
                {"gaps", gaps},
                {"gap_count", found.timing.gap_count},
                {"lost", found.timing.lost},
                {"polarity", name_of(found.polarity)},
                {"idle_counts", found.idle_counts},
                {"noise_counts", fact_of(found.noise)},
                {"drift_counts_per_minute", found.drift ? fact_of(*found.drift) : Json(nullptr)},
                {"contact_counts", found.contact_counts},
                {"contact_frames", found.contact_frames},
                {"idle_frames", found.idle_frames},
                {"clipped", found.clipped},
                {"layout", name_of(found.layout)},
                {"row_order_tested", found.row_order_tested},
                {"column_order_tested", found.column_order_tested},
                {"untouched", found.untouched},
                {"touch_here", found.touch_here},
                {"never_differ", found.never_differ},
                {"findings", Json::array()}};
  for (const ArrayFinding& finding : found.findings) facts["findings"].push_back(fact_of(finding));
  return facts;
}

}  // namespace pillarfield
