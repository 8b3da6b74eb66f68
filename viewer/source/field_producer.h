#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pillarfield/calibration.h"
#include "pillarfield/processor.h"
#include "pillarfield/read_options.h"
#include "pillarfield/skin.h"
#include "viewer/source/shown_contacts.h"
#include "viewer/source/shown_field.h"

namespace pillarfield::viewer {

/// What there is to see in a source.
struct SourceInfo {
  std::string name;           ///< of the file
  std::string kind;           ///< "scene", "recording", "Tekscan ASCII" or "force field"
  Skin skin;                  ///< of a force file only size and pitch are known
  Calibration calibration;    ///< empty of a force file
  std::uint64_t frames = 0;   ///< at least one
  double rate_hz = 100;       ///< frames per second of the source's own time
  bool has_readings = false;  ///< ShownField::raw has data
  bool has_angles = false;    ///< magnitude, theta and phi; true of all sources there are
  bool has_uncertainty = false;
  std::string solver;  ///< "direct on NAME OF DEVICE, zero copy"; for a force file who solved it
  ContactOptions contacts = {};       ///< what is known of contacts that are looked for
  std::vector<std::string> warnings;  ///< what a user should know, one sentence each
};

/// Makes the fields of a source, one by one and in any order. For one thread.
class FieldProducer {
 public:
  static constexpr int kMostShown = 6;

  FieldProducer() = default;
  virtual ~FieldProducer() = default;  ///< fields that are alive stay as they are
  FieldProducer(const FieldProducer&) = delete;
  FieldProducer& operator=(const FieldProducer&) = delete;

  [[nodiscard]] virtual const SourceInfo& info() const = 0;

  /// The field of frame `index`, read or solved now, always with angles. At most kMostShown fields
  /// may be alive at a time, whose copies may go in any thread; throws Error beyond, and where
  /// there is no such frame or reading or solving fails.
  [[nodiscard]] virtual ShownField produce(std::uint64_t index) = 0;

  /// The contacts of the field that was produced last: those that the source knows, or else such as
  /// are found now, by what was asked for before. Throws Error where reading fails.
  [[nodiscard]] virtual ShownContacts contacts_of(const ShownField& field);

  /// Looks whether the source has grown (a recording that is still being written); true if its
  /// number of frames is another now, which info() tells.
  virtual bool refresh() { return false; }

 private:
  std::optional<ContactWatch> watch_;
};

struct ProducerOptions {
  std::string device = {};  ///< as open_device() takes it
  Memory memory = Memory::automatic;
  ReadOptions read = {};  ///< of a file, when it is opened first
  /// Frames of a scene are simulated beforehand, as many as it has and fit.
  std::uint64_t memory_bytes = std::uint64_t{2} << 30;
  std::uint64_t most_frames = 0;                              ///< of a scene; 0: all
  std::function<void(const std::string&)> on_compiling = {};  ///< as Processor::Options has it
};

/// Opens a scene (.toml), a recording, a Tekscan ASCII export or a file of force fields, told apart
/// by name (scenes) and content (the others). Frames of the first three are solved with angles, and
/// with uncertainty where the noise is known and the estimator can tell. A scene's baseline stays,
/// since frames may come in any order; where its frames are close in time, one that is produced
/// right after the frame before it knows of that.
/// `progress` is called with shares 0..1 while a scene is simulated; it may throw to stop. Throws
/// Error where the source cannot be opened or has no frames.
[[nodiscard]] std::unique_ptr<FieldProducer> open_producer(
    const std::filesystem::path& path, const ProducerOptions& options,
    const std::function<void(double)>& progress = {});

}  // namespace pillarfield::viewer
