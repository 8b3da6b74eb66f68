// pillarfield compare: solved forces against the truth by region.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/number_text.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/json_text.h"
#include "cli/progress.h"
#include "cli/warnings.h"
#include "pillarfield/comparison.h"
#include "pillarfield/coverage.h"
#include "pillarfield/error.h"
#include "pillarfield/force_file.h"
#include "pillarfield/printable.h"
#include "pillarfield/recording.h"
#include "pillarfield/resultant_comparison.h"
#include "pillarfield/status.h"

namespace pillarfield::cli {
namespace {

/// Coverage of normal force on sensels without pillars: truths within 1.96 deviations, of those
/// that are loaded and not flagged.
struct SenselCoverage {
  std::uint64_t sensels = 0;
  std::uint64_t covered = 0;

  void add(const ForceField& solved, const ForceField& truth) {
    const std::vector<float>& deviations = solved.uncertainty[Uncertainty::normal];
    for (std::size_t i = 0; i < deviations.size(); ++i) {
      if (solved.status[i] != status::kSensel1) continue;
      ++sensels;
      const float error = std::abs(solved.normal[i] - truth.normal[i]);
      if (error <= 1.96F * deviations[i]) ++covered;
    }
  }
  [[nodiscard]] double share() const {
    return static_cast<double>(covered) / static_cast<double>(std::max<std::uint64_t>(1, sensels));
  }
};

struct Row {
  std::string name;
  RegionErrors errors;
};

std::vector<Row> rows_of(const Comparison& comparison, SkinLayout layout) {
  std::vector<Row> rows;
  for (const Region region : {Region::one, Region::two, Region::three, Region::four}) {
    if (layout == SkinLayout::pillars) {
      rows.push_back({name_of(region), comparison.region(region)});
    }
  }
  rows.push_back({"loaded", comparison.loaded()});
  rows.push_back({"none", comparison.region(Region::none)});
  return rows;
}

/// A percentage with one decimal; "> 999%" above, "-" without a true value.
std::string percentage(double part, double whole) {
  if (!(whole > 0)) return "-";
  const double percent = 100 * part / whole;
  return percent <= 999 ? fmt::format("{:.1f}%", percent) : "> 999%";
}

constexpr std::array kCoveredRegions = {Region::one, Region::two, Region::three, Region::four};

nlohmann::ordered_json json_of_resultant(const ResultantErrors& errors) {
  return {{"true_rms_n", errors.force.true_rms},
          {"error_rms_n", errors.force.rms},
          {"worst_error_n", errors.force.worst},
          {"worst_frame", errors.force.worst_frame},
          {"true_torque_rms_nmm", errors.torque.true_rms},
          {"torque_error_rms_nmm", errors.torque.rms},
          {"worst_torque_error_nmm", errors.torque.worst},
          {"worst_torque_frame", errors.torque.worst_frame}};
}

nlohmann::ordered_json json_of_contacts(const ContactErrors& errors) {
  return {{"found", errors.found},
          {"missed", errors.missed},
          {"extra", errors.extra},
          {"missed_normal_n", errors.missed_normal_n},
          {"extra_normal_n", errors.extra_normal_n},
          {"true_rms_n", errors.force.true_rms},
          {"error_rms_n", errors.force.rms},
          {"worst_error_n", errors.force.worst},
          {"true_torque_rms_nmm", errors.torque.true_rms},
          {"torque_error_rms_nmm", errors.torque.rms},
          {"worst_torque_error_nmm", errors.torque.worst},
          {"centre_error_rms_mm", errors.centre.rms},
          {"worst_centre_error_mm", errors.centre.worst}};
}

/// Without pillars there are neither angles nor torques, nor sensels that share a pillar.
void print_sensel_json(const std::vector<Row>& rows, const ResultantComparison& resultants,
                       const std::optional<SenselCoverage>& coverage, std::uint64_t frames) {
  nlohmann::ordered_json json = {{"frames", frames}, {"layout", name_of(SkinLayout::sensels)}};
  for (const auto& [name, errors] : rows) {
    json["sensels"][name] = {{"sensels", errors.pillars},
                             {"rms_n", errors.rms_n},
                             {"p95_n", errors.p95_n},
                             {"rms_relative", errors.rms_relative},
                             {"p95_relative", errors.p95_relative}};
  }
  json["resultant"] = json_of_resultant(resultants.patch());
  json["contacts"] = json_of_contacts(resultants.contacts());
  for (const char* torque : {"true_torque_rms_nmm", "torque_error_rms_nmm",
                             "worst_torque_error_nmm", "worst_torque_frame"}) {
    json["resultant"].erase(torque);
    json["contacts"].erase(torque);
  }
  if (coverage) json["coverage"] = {{"sensels", coverage->sensels}, {"normal", coverage->share()}};
  fmt::print("{}\n", json_text(json));
}

void print_json(const std::vector<Row>& rows, const ResultantComparison& resultants,
                const std::optional<Coverage>& coverage, std::uint64_t frames) {
  nlohmann::ordered_json regions;
  for (const auto& [name, errors] : rows) {
    regions[name] = {{"pillars", errors.pillars},
                     {"status_mismatches", errors.status_mismatches},
                     {"rms_n", errors.rms_n},
                     {"p95_n", errors.p95_n},
                     {"rms_relative", errors.rms_relative},
                     {"p95_relative", errors.p95_relative},
                     {"theta_rms_rad", errors.theta_rms_rad},
                     {"phi_rms_rad", errors.phi_rms_rad}};
  }
  nlohmann::ordered_json json = {{"frames", frames},
                                 {"regions", regions},
                                 {"resultant", json_of_resultant(resultants.patch())},
                                 {"contacts", json_of_contacts(resultants.contacts())}};
  if (coverage) {
    for (const Region region : kCoveredRegions) {
      const RegionCoverage of_region = coverage->region(region);
      json["coverage"][name_of(region)] = {{"pillars", of_region.pillars},
                                           {"shear_x", of_region.shear_x},
                                           {"shear_y", of_region.shear_y},
                                           {"normal", of_region.normal},
                                           {"ends", of_region.ends}};
    }
  }
  fmt::print("{}\n", json_text(json));
}

/// Formats a number with `decimals`, or with an exponent if it exceeds the column.
std::string fitted(double value, std::size_t width, int decimals) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.size() > width) text = fmt::format("{:.1e}", value);
  return fmt::format("{:>{}}", text, width);
}

void print_row(const Row& row) {
  const RegionErrors& errors = row.errors;
  if (errors.pillars == 0) {
    fmt::print("{:<8} {:>13} {:>9} {:>9} {:>8} {:>8} {:>9} {:>9} {:>10}\n", row.name, 0, "-", "-",
               "-", "-", "-", "-", "-");
    return;
  }
  const double mismatches =
      100 * static_cast<double>(errors.status_mismatches) / static_cast<double>(errors.pillars);
  fmt::print("{:<8} {:>13} {} {}", row.name, grouped(errors.pillars), fitted(errors.rms_n, 9, 4),
             fitted(errors.p95_n, 9, 4));
  if (row.name == "none") {
    fmt::print(" {:>8} {:>8} {:>9} {:>9}", "-", "-", "-", "-");
  } else {
    fmt::print(" {:>8} {:>8} {:>9.4f} {:>9.4f}", percentage(errors.rms_relative, 1),
               percentage(errors.p95_relative, 1), errors.theta_rms_rad, errors.phi_rms_rad);
  }
  fmt::print(" {:>9.1f}%\n", mismatches);
}

void print_errors(const char* name, const VectorErrors& errors) {
  if (errors.cases == 0) return;
  const std::string truth = errors.true_rms > 0 ? fitted(errors.true_rms, 9, 4) : "-";
  fmt::print("{:<26} {:>9} {} {:>8} {} {:>8}\n", name, truth, fitted(errors.rms, 9, 4),
             percentage(errors.rms, errors.true_rms), fitted(errors.worst, 9, 4),
             percentage(errors.worst, errors.worst_true));
}

void print_resultants(const ResultantComparison& resultants, bool has_torque) {
  const ContactErrors& contacts = resultants.contacts();
  fmt::print("\n{:<26} {:>9} {:>9} {:>8} {:>9} {:>8}\n", "", "true RMS", "RMS error", "of true",
             "worst", "of true");
  print_errors("Resultant force, N", resultants.patch().force);
  if (has_torque) print_errors("Resultant torque, N mm", resultants.patch().torque);
  print_errors("Force of a contact, N", contacts.force);
  if (has_torque) print_errors("Torque of a contact, N mm", contacts.torque);
  print_errors("Centre of pressure, mm", contacts.centre);
  fmt::print("Contacts: {} found", grouped(contacts.found));
  const auto print_others = [](const char* kind, std::uint64_t count, double most_n) {
    fmt::print(", {} {}", grouped(count), kind);
    if (count > 0) fmt::print(" (of at most {} N)", rounded(most_n));
  };
  print_others("missed", contacts.missed, contacts.missed_normal_n);
  print_others("extra", contacts.extra, contacts.extra_normal_n);
  fmt::print("\n");
}

void print_text(const std::vector<Row>& rows, const ResultantComparison& resultants,
                std::uint64_t frames, const CompareOptions& options) {
  fmt::print("{} against the truth in {}, {}\n\n", printable(options.forces),
             printable(options.recording), counted(frames, "frame"));
  fmt::print("{:<8} {:>13} {:^19} {:^17} {:^19} {:>10}\n", "true", "", "force error, N",
             "of the true force", "angle RMS, rad", "status");
  fmt::print("{:<8} {:>13} {:>9} {:>9} {:>8} {:>8} {:>9} {:>9} {:>10}\n", "region", "pillars",
             "RMS", "95 %", "RMS", "95 %", "theta", "phi", "differs");
  for (const Row& row : rows) print_row(row);
  print_resultants(resultants, true);
  fmt::print(
      "\nForce error: length of (solved - true). 95 %: the 95th percentile over pillars.\n"
      "phi is weighted by sin(theta). Status differs: the usable sensels differ from those of the "
      "ideal model.\n"
      "Region 3 is ambiguous: two readings, three unknowns.\n"
      "Resultant torque: about the centre of the patch. Torque of a contact: about the normal "
      "through "
      "its\ntrue centre of pressure. Worst: the largest error of a frame or contact.\n");
}

void print_sensel_text(const std::vector<Row>& rows, const ResultantComparison& resultants,
                       const std::optional<SenselCoverage>& coverage, std::uint64_t frames,
                       const CompareOptions& options) {
  fmt::print("{} against the truth in {}, {}\n\n", printable(options.forces),
             printable(options.recording), counted(frames, "frame"));
  fmt::print("{:<8} {:>13} {:^19} {:^17}\n", "", "", "force error, N", "of the true force");
  fmt::print("{:<8} {:>13} {:>9} {:>9} {:>8} {:>8}\n", "", "sensels", "RMS", "95 %", "RMS", "95 %");
  for (const auto& [name, errors] : rows) {
    const bool loaded = name == "loaded" && errors.pillars > 0;
    fmt::print("{:<8} {:>13} {} {} {:>8} {:>8}\n", name, grouped(errors.pillars),
               fitted(errors.rms_n, 9, 4), fitted(errors.p95_n, 9, 4),
               loaded ? percentage(errors.rms_relative, 1) : "-",
               loaded ? percentage(errors.p95_relative, 1) : "-");
  }
  print_resultants(resultants, false);
  fmt::print(
      "\n95 %: the 95th percentile over sensels. Worst: the largest error of a frame or "
      "contact.\n");
  if (!coverage) return;
  fmt::print("Truths within 1.96 deviations: {:.1f}% of {} loaded sensels without a flag\n",
             100 * coverage->share(), grouped(coverage->sensels));
}

void print_coverage(const Coverage& coverage) {
  fmt::print("\n{:<8} {:>13} {:^29} {:>12}\n", "solved", "", "truths within 1.96 deviations",
             "in the");
  fmt::print("{:<8} {:>13} {:>9} {:>9} {:>9} {:>12}\n", "region", "pillars", "shear_x", "shear_y",
             "normal", "interval");
  for (const Region region : kCoveredRegions) {
    const RegionCoverage of_region = coverage.region(region);
    fmt::print("{:<8} {:>13} {:>8.1f}% {:>8.1f}% {:>8.1f}% {:>11.1f}%\n", name_of(region),
               grouped(of_region.pillars), 100 * of_region.shear_x, 100 * of_region.shear_y,
               100 * of_region.normal, 100 * of_region.ends);
  }
  fmt::print(
      "\nRegions 1 and 2 should have 95 %. Interval: of theta, phi and magnitude, widened by "
      "three\n"
      "deviations, since it excludes noise. Pillars with flagged sensels are left out.\n");
}

/// Checks that the files belong to one patch and returns the number of frames in both.
std::uint64_t common_frames(const ForceFileReader& forces, const FrameSource& recording,
                            const CompareOptions& options) {
  if (!recording.has_truth()) {
    throw Error(options.recording, "it has no truth",
                "give a recording made by 'pillarfield simulate'");
  }
  const Skin& skin = recording.skin();
  const ForceFileInfo& info = forces.info();
  if (info.layout != skin.layout || info.rows != skin.element_rows() ||
      info.cols != skin.element_cols()) {
    throw Error(options.forces,
                fmt::format("it has {} x {} {} and {} has {} x {} {}", info.rows, info.cols,
                            name_of(info.layout), options.recording, skin.element_rows(),
                            skin.element_cols(), name_of(skin.layout)),
                "give the recording that these forces were solved from");
  }
  const std::uint64_t left = recording.frames() - std::min(info.first_frame, recording.frames());
  if (info.first_frame > 0 && forces.frames() > left) {
    throw Error(options.forces,
                fmt::format("it holds frames from {} on, and {} has {}", info.first_frame,
                            options.recording, recording.frames()),
                "give the recording that these forces were solved from");
  }
  if (info.first_frame > 0) return forces.frames();
  const std::uint64_t frames = std::min(forces.frames(), recording.frames());
  if (forces.frames() != recording.frames()) {
    fmt::print(stderr, "{}: it has {} and {} has {}; what both have is compared\n",
               printable(options.forces), counted(forces.frames(), "frame"),
               printable(options.recording), recording.frames());
  }
  return frames;
}

}  // namespace

void compare(const CompareOptions& options) {
  const ForceFileReader forces(options.forces, options.read);
  const std::unique_ptr<FrameSource> recording =
      open_frames(options.recording, {.trust = options.read.trust, .untimed = true});
  const std::uint64_t frames = common_frames(forces, *recording, options);
  const ForceFileInfo& info = forces.info();
  const std::uint64_t first = info.first_frame;
  ForceField solved(info.rows, info.cols);
  ForceField truth(info.rows, info.cols);
  Comparison comparison;
  ResultantComparison resultants(info.element_pitch_mm);
  const bool has_pillars = info.layout == SkinLayout::pillars;
  std::optional<Coverage> coverage;
  std::optional<SenselCoverage> sensel_coverage;
  if (info.uncertainty && has_pillars) coverage.emplace();
  if (info.uncertainty && !has_pillars) sensel_coverage.emplace();
  {
    Progress progress("Comparing", frames, options.quiet);
    for (std::uint64_t index = 0; index < frames; ++index) {
      stop_if_interrupted(index, options.forces);
      forces.read(index, solved);
      recording->read_truth(first + index, truth);
      if (sensel_coverage) sensel_coverage->add(solved, truth);
      comparison.add(solved.view(), truth.view());
      if (!has_pillars) {
        // The comparison of vectors, whose shear is exact.
        for (ForceField* field : {&solved, &truth}) {
          field->shear_x.assign(field->elements(), 0);
          field->shear_y.assign(field->elements(), 0);
        }
      }
      resultants.add(solved.view(), truth.view());
      if (coverage) coverage->add(solved.view(), truth.view());
      progress.show(index + 1);
    }
  }
  const std::vector<Row> rows = rows_of(comparison, info.layout);
  if (!has_pillars) {
    if (options.json) return print_sensel_json(rows, resultants, sensel_coverage, frames);
    return print_sensel_text(rows, resultants, sensel_coverage, frames, options);
  }
  if (options.json) {
    print_json(rows, resultants, coverage, frames);
  } else {
    print_text(rows, resultants, frames, options);
    if (coverage) print_coverage(*coverage);
  }
}

}  // namespace pillarfield::cli
