// Contacts of closed form: single frames.

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "report/field/section.h"
#include "report/table.h"

namespace pillarfield::report {
namespace {

using field_study::Score;

constexpr const char* kIntroduction = R"(## Closed forms

{} single frames of contacts of 12 to 45 pillars radius whose pressure and shear are closed forms of contact mechanics, or obey friction with a made-up pressure (the wavy body, two spheres and the punch's stuck core): each contact at frictions of 1.45, 1.6, 2 and 2.5 and with noise of 0.25, 0.5 and 1
counts, float32 readings, threshold four times the noise. RMS error in region 3, counts, all pillars of a kind together; the worst ratio is that of single frames with {} ambiguous pillars or more.

)";

double worst_ratio(const FieldContext& context, const Kind& kind) {
  double worst = 0;
  for (const ClosedFormResult& result : context.closed_forms) {
    if (!kind.holds(result.scene) || result.open() < kEnoughPillars) continue;
    worst = std::max(worst, result.to_paper(kContact));
  }
  return worst;
}

}  // namespace

std::string closed_forms_section(const FieldContext& context) {
  Table table("lrrrrrrrrr", {"", "frames", "ambiguous, %", "`paper`", "`direct`", "`contact`",
                             "friction given", "noise alone", "`contact` over `paper`", "worst"});
  for (const Kind& kind : kinds()) {
    const auto holds = [&](const ClosedFormResult& result) { return kind.holds(result.scene); };
    const auto of = [&](std::size_t method) { return pooled(context.closed_forms, method, holds); };
    const Score noise = pooled_nearest(context.closed_forms, holds);
    const double worst = worst_ratio(context, kind);
    table.add({kind.name,
               fmt::format("{}", std::count_if(context.closed_forms.begin(),
                                               context.closed_forms.end(), holds)),
               percent_text(static_cast<double>(noise.open) / static_cast<double>(noise.loaded)),
               rms_text(of(kPaper)), rms_text(of(kDirect)), rms_text(of(kContact)),
               rms_text(of(kGiven)), rms_text(noise),
               fmt::format("{:.3f}", of(kContact).rms_counts() / of(kPaper).rms_counts()),
               worst > 0 ? fmt::format("{:.2f}", worst) : "–"});
  }
  return fmt::format(fmt::runtime(kIntroduction), context.closed_forms.size(), kEnoughPillars) +
         table.text();
}

}  // namespace pillarfield::report
