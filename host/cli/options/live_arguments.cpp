// The options of the commands that run in real time, their help and its examples.

#include <fmt/format.h>

#include <limits>

#include "cli/options/shared_arguments.h"

namespace pillarfield::cli {
namespace {

/// Accepts the origin of a web page.
CLI::Validator origin() {
  const auto error_of = [](const std::string& text) -> std::string {
    const bool has_scheme = text.starts_with("http://") || text.starts_with("https://");
    return has_scheme && text.find('/', text.find("//") + 2) == std::string::npos
               ? ""
               : fmt::format("'{}' is not an origin, such as https://app.foxglove.dev", text);
  };
  return {error_of, ""};
}

void add_stream_ends(CLI::App* command, StreamOptions& options) {
  Group output(command, "Output");
  output
      .text(
          "--to", options.sinks, "SINK",
          "Send forces on, any number of times: shm:NAME, udp:ADDRESS:PORT, web[:PORT] (a page in "
          "the browser), foxglove[:PORT], FILE.mcap, or a file as solve writes it")
      ->allow_extra_args(false);
  output
      .text("--allow-origin", options.allowed_origins, "ORIGIN",
            "Let a web page connect to foxglove or web, any number of times, such as "
            "https://app.foxglove.dev")
      ->allow_extra_args(false)
      ->check(origin());
  output.text("--relay", options.relay, "shm:NAME",
              "Put the raw frames into a ring in shared memory, for other programs");
  output.text("--record", options.record, "FILE",
              "Record the raw frames (HDF5); with --newest those that are solved");
  add_overwrite(command, options.replace);
  Group run(command, "Run");
  run.number("--seconds", options.seconds, "SECONDS", "End after this time [at the source's end]",
             1e-3, 1e9);
  run.whole("--frames", options.frames, "N", "End after this many frames", 1,
            std::numeric_limits<std::int64_t>::max());
  run.number("--end-when-idle", options.most_idle_s, "SECONDS",
             "End when no frame came for this time [wait for the sensor]", 0.01, 1e9);
  run.number(
      "--tare", options.tare_s, "SECONDS",
      "Measure the tare of the untouched skin over this time at the start; frames before its end "
      "go to no sink [0]",
      0, 60);
  command
      ->add_option(
          "--control", options.control,
          "Take lines of 'pillarfield control' from a socket, a name in $XDG_RUNTIME_DIR or "
          "a path, or from standard input (-)")
      ->type_name("SOCKET|-")
      ->group("Run");
  run.number("--health-interval", options.health_interval_s, "SECONDS",
             "Time between reports of health [1]", 0.05, 3600);
}

}  // namespace

void add_stream(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<StreamOptions>(
      parent, work, stream, "stream",
      "Solve live frames of a sensor and send their forces on (docs/streams.md).",
      "  pillarfield stream scenes/demo.toml --frames 50 --record live.h5\n"
      "  pillarfield stream scenes/demo.toml --repeat --seconds 1 --to udp:127.0.0.1:9870\n"
      "  pillarfield stream scenes/demo.toml --repeat --seconds 2 --rate 500 --summary\n");
  Group input(command, "Input");
  command
      ->add_option(
          "SOURCE", options->source,
          "- (packets on standard input), shm:NAME, udp:ADDRESS:PORT, serial:DEVICE (of a FlexiTac "
          "board 'serial:DEVICE?protocol=flexitac&rows=16&cols=32', or serial:auto, which finds "
          "it), or a scene or file of frames, replayed at its own pace")
      ->required()
      ->type_name("SOURCE")
      ->group("Input");
  CLI::Option* const rate =
      input.number("--rate", options->rate_hz, "HZ",
                   "Frames per second of a replayed file [its own], or of the sensor", 0.01, 1e5);
  input.flag("--repeat", options->repeat, "Replay a file again and again");
  input.flag("--newest", options->newest,
             "Where frames of a live source wait, solve (and record) the newest alone; the others "
             "count as lost");
  input.whole("--baud", options->serial_baud, "BAUD", "Bits per second of serial: [2000000]", 300,
              100'000'000);
  add_plain_data(command, options->plan.read, false);
  add_stream_ends(command, *options);
  Group(command, "Run")
      .flag("--summary", options->summary,
            "Measure whether this computer keeps up with --rate: drop late frames of a file, print "
            "latencies and losses at the end")
      ->needs(rate);
  add_sensor(command, options->plan);
  add_solver(command, options->plan);
  add_contacts(command, options->contacts);
  add_device(command, options->device);
  Group(command, "Device")
      .whole("--in-flight", options->frames_in_flight, "FRAMES",
             "Number of frames in the solver at once [2]", 1, 64);
  add_general(command, *options, "Print reports of health and the summary as lines of JSON",
              kQuietWriter);
}

void add_control(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<ControlOptions>(
      parent, work, control, "control",
      "Send a line of control to a running stream and print its answer.",
      "  pillarfield control skin tare\n"
      "  pillarfield control skin record session.h5\n"
      "  pillarfield control skin record stop\n");
  Group input(command, "Input");
  input.text("SOCKET", options->socket, "SOCKET", "Socket of stream --control, by the same name")
      ->required();
  command
      ->add_option("LINE", options->words,
                   "tare [SECONDS] [preloaded], pause, resume, record FILE, record stop, health or "
                   "quit (docs/streams.md)")
      ->required()
      ->type_name("LINE")
      ->group("Input");
  add_help(command);
}

void add_doctor(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<DoctorOptions>(
      parent, work, doctor, "doctor",
      "Look at the frames of any pressure array: what is broken, shorted or wired wrongly.",
      "  pillarfield simulate scenes/calibration/new_skin_rolled.toml --uncalibrated -o rolled.h5\n"
      "  pillarfield doctor rolled.h5\n"
      "  pillarfield doctor rolled.h5 --json\n");
  Group input(command, "Input");
  command
      ->add_option("SOURCE", options->source,
                   "Frames as of solve, or a live source: - (packets on standard input), shm:NAME, "
                   "udp:ADDRESS:PORT, serial:DEVICE")
      ->required()
      ->type_name("FILE|SOURCE")
      ->group("Input");
  input.number("--seconds", options->seconds, "SECONDS", "Time to look at a live source [10]", 0.1,
               3600);
  input.whole("--baud", options->serial_baud, "BAUD", "Bits per second of serial: [2000000]", 300,
              100'000'000);
  add_trust(command, options->read);
  add_plain_data(command, options->read, true);
  command->remove_option(command->get_option("--pitch-mm"));  // Nothing here is a length.
  add_general(command, *options, "Print the findings as JSON", kQuietReport);
}

}  // namespace pillarfield::cli
