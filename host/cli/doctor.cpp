// pillarfield doctor: what is wrong with a pressure array.

#include "pillarfield/doctor.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>

#include "base/number_text.h"
#include "calibration/doctor/diagnosis_facts.h"
#include "cli/commands.h"
#include "cli/json_text.h"
#include "cli/progress.h"
#include "cli/warnings.h"
#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"
#include "pillarfield/live.h"
#include "pillarfield/printable.h"
#include "pillarfield/tare.h"

namespace pillarfield::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Some of the frames alone may mislead.
void refuse_interrupted(const DoctorOptions& options) {
  if (!is_interrupted()) return;
  throw Error(options.source, "the doctor was interrupted before it saw all frames",
              "let it run to its end, or give fewer frames");
}

Diagnosis look_at_file(const DoctorOptions& options) {
  ReadOptions read = options.read;
  read.untimed = !read.rate_hz;
  // Constants of forces do not matter here, so that none is missing.
  read.sensel_pitch_mm = 1;
  read.counts_per_newton = 1;
  read.readings = "counts";
  read.threshold_counts = 0;
  const auto source = open_frames_with_warnings(options.source, read, options.quiet);
  Doctor doctor(options.source, source->skin(), source->sensel_type());
  FrameBuffer frame(source->sensel_type(), source->skin().rows, source->skin().cols);
  Progress progress("Reading", source->frames(), options.quiet);
  for (std::uint64_t index = 0; index < source->frames() && !is_interrupted(); ++index) {
    const double time_s = source->read(index, frame);
    doctor.add(frame.view(), time_s);
    progress.show(index + 1);
  }
  refuse_interrupted(options);
  return doctor.result();
}

Diagnosis look_at_source(const DoctorOptions& options) {
  using SourceClock = std::chrono::steady_clock;
  if (const auto say = terminal_line(options.quiet)) {
    say(fmt::format("Looking at {} for {:g} s; sweep a finger over all of it ...", options.source,
                    options.seconds));
  }
  LiveSourceOptions live;
  live.stop = is_interrupted;
  live.serial_baud = options.serial_baud;
  live.read = options.read;
  const auto length = std::chrono::duration_cast<SourceClock::duration>(
      std::chrono::duration<double>(options.seconds));
  const auto end = SourceClock::now() + length;
  live.most_wait = length;
  live.say = [&](const std::string& words) {
    fmt::print(stderr, "pillarfield: {}: {}\n", printable(options.source), words);
  };
  const auto stream = open_live_source(options.source, live);
  if (!stream) {
    throw Error(options.source, "was interrupted before a frame came", "start its sender");
  }
  Doctor doctor(options.source, stream->skin(), stream->sensel_type());
  StreamedFrame frame(stream->sensel_type(), stream->skin());
  while (SourceClock::now() < end && !is_interrupted()) {
    const Arrival arrival = stream->next(frame, std::chrono::milliseconds(100));
    if (arrival == Arrival::ended) break;
    if (arrival == Arrival::arrived) doctor.add(frame.readings, frame.time_s);
  }
  refuse_interrupted(options);
  return doctor.result();
}

std::string place_text(const SenselPlace& place) {
  return fmt::format("({}, {})", place.first, place.second);
}

/// A word that a shell reads as it is.
std::string quoted(const std::string& word) {
  const bool is_plain = word.find_first_not_of(
                            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                            "0123456789_-./:,=?&@%+") == std::string::npos;
  if (is_plain && word.find_first_of("?&") == std::string::npos) return word;
  std::string text = "'";
  for (const char each : word) text += each == '\'' ? std::string("'\\''") : std::string(1, each);
  return text + "'";
}

/// The options that make other commands read the file as this one did.
std::string reading_arguments(const ReadOptions& read) {
  std::string text;
  if (!read.dataset.empty()) text += " --dataset " + quoted(read.dataset);
  if (!read.times.empty()) text += " --times " + quoted(read.times);
  if (read.frame_size) {
    text += fmt::format(" --shape {}x{}", read.frame_size->rows, read.frame_size->cols);
  }
  if (!read.columns.empty()) text += " --columns " + quoted(read.columns);
  if (!read.where.empty()) text += " --where " + quoted(read.where);
  if (!read.axes.empty()) {
    std::vector<const char*> words;
    for (const ArrayAxis axis : read.axes) {
      words.push_back(axis == ArrayAxis::frames ? "frames"
                      : axis == ArrayAxis::rows ? "rows"
                                                : "columns");
    }
    text += fmt::format(" --axes {}", fmt::join(words, ","));
  }
  return text;
}

/// The command to type next: an idle file gives a tare, others forces; "" without any force.
std::string next_command(const DoctorOptions& options, const Diagnosis& found) {
  if (found.is_no_force()) return "";
  const std::string source = quoted(options.source);
  const std::string falling = found.polarity == Polarity::falls ? " --falling" : "";
  const std::string layout = found.layout == SkinLayout::pillars ? " --layout pillars" : "";
  if (is_live_source(options.source)) {
    if (found.contact_frames == 0) return fmt::format("pillarfield doctor {} --seconds 30", source);
    return fmt::format("pillarfield stream {}{}{} --tare 2 --record recording.h5", source, layout,
                       falling);
  }
  const std::string reading = reading_arguments(options.read);
  if (found.contact_frames == 0) {
    return fmt::format("pillarfield calibrate tare {}{} -o tared.h5", source, reading);
  }
  const std::string rate = options.read.rate_hz   ? fmt::format(" --rate {}", *options.read.rate_hz)
                           : found.timing.rate_hz ? ""
                                                  : " --rate HZ";
  const std::string tare = found.idle_frames >= kLeastTareFrames
                               ? fmt::format(" --tare-frames {}", found.idle_frames)
                               : "";
  return fmt::format("pillarfield solve {}{}{}{}{}{} -o forces.h5", source, reading, rate, layout,
                     falling, tare);
}

Json json_of(const DoctorOptions& options, const Diagnosis& found) {
  Json json = {{"source", options.source}};
  json.update(facts_of(found));
  json["next"] = next_command(options, found);
  return json;
}

std::string timing_text(const FrameTiming& timing) {
  if (!timing.rate_hz) return "no times; give --rate HZ";
  std::string text =
      fmt::format("{} Hz, jitter {:.2f} ms", rounded(*timing.rate_hz), timing.jitter_ms);
  if (timing.gap_count == 0) return text + ", no gaps";
  const FrameGap& first = timing.gaps.front();
  return text + fmt::format(", {} with room for {}, the first of {} s before frame {}",
                            counted(timing.gap_count, "gap"), counted(timing.lost, "frame"),
                            rounded(first.length_s), first.frame);
}

std::string worst_text(const SenselFigure& figure) {
  return fmt::format("{} counts (farthest {} at {})", fixed(figure.median, 2),
                     fixed(figure.worst, 2), place_text(figure.place));
}

std::string load_text(const Diagnosis& found) {
  if (found.polarity == Polarity::unknown)
    return "no contact stands out; sweep a finger over the array";
  std::string text = fmt::format(
      "readings {} under load{}, by {} counts, in {} of the {} looked at",
      found.polarity == Polarity::rises ? "rise" : "fall",
      found.polarity == Polarity::rises ? "" : " (--falling)", rounded(found.contact_counts),
      grouped(found.contact_frames), counted(found.kept, "frame"));
  if (found.clipped > 0) {
    text += fmt::format("; {} reached full scale", counted(found.clipped, "sensel"));
  }
  return text;
}

std::string tested_text(const Diagnosis& found) {
  const auto order = [](bool tested) { return tested ? "tested" : "not tested: sweep a finger"; };
  const std::uint64_t differ = std::uint64_t{found.rows} * found.cols - found.never_differ;
  std::string text =
      fmt::format("{} of {}", grouped(differ - found.untouched.size()), counted(differ, "sensel"));
  if (!found.touch_here.empty()) {
    std::vector<std::string> places;
    for (const SenselPlace& place : found.touch_here) places.push_back(place_text(place));
    text += fmt::format("; not tested, touch here: {}{}", fmt::join(places, ", "),
                        places.size() < found.untouched.size() ? " and around" : "");
  }
  if (found.never_differ > 0) {
    text += fmt::format("; {} more never {}", grouped(found.never_differ),
                        found.never_differ == 1 ? "differs" : "differ");
  }
  return text + fmt::format("\n             order of rows {}, of columns {}",
                            order(found.row_order_tested), order(found.column_order_tested));
}

void print(const DoctorOptions& options, const Diagnosis& found) {
  fmt::print("{}: {} of {} x {} sensels, {}\n", printable(options.source),
             counted(found.frames, "frame"), found.rows, found.cols, name_of(found.type));
  fmt::print("  times      {}\n", timing_text(found.timing));
  fmt::print("  idle       {} counts, noise {}\n", rounded(found.idle_counts),
             worst_text(found.noise));
  if (found.drift) {
    fmt::print("  drift      {} per minute\n", worst_text(*found.drift));
  }
  fmt::print("  load       {}\n", load_text(found));
  fmt::print("  tested     {}\n", tested_text(found));
  for (const ArrayFinding& finding : found.findings) fmt::print("  ! {}\n", finding.text);
  if (found.findings.empty()) fmt::print("  Nothing wrong was found.\n");
  const std::string next = next_command(options, found);
  fmt::print("Next: {}\n",
             next.empty() ? "record other frames: these hold no force" : printable(next));
}

}  // namespace

void doctor(const DoctorOptions& options) {
  const Diagnosis found =
      is_live_source(options.source) ? look_at_source(options) : look_at_file(options);
  if (options.json) {
    fmt::print("{}\n", json_text(json_of(options, found)));
  } else {
    print(options, found);
  }
}

}  // namespace pillarfield::cli
