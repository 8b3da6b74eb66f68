#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pillarfield/calibration.h"
#include "pillarfield/plan_builder.h"
#include "pillarfield/processor.h"
#include "pillarfield/skin.h"
#include "pillarfield/solver_plan.h"
#include "viewer/source/curves.h"
#include "viewer/source/shown_contacts.h"
#include "viewer/source/shown_field.h"

namespace pillarfield::viewer {

/// Properties of a source of fields.
struct SourceInfo {
  std::string name;           ///< of the file
  std::string kind;           ///< "scene", "recording", "sensor", "results", "force field", ...
  Skin skin;                  ///< a force file gives only size and pitch
  Calibration calibration;    ///< empty for a force file
  std::uint64_t frames = 0;   ///< at least one
  double rate_hz = 100;       ///< frames per second, by the times in the source
  bool has_readings = false;  ///< ShownField::raw has data
  bool has_angles = false;    ///< magnitude, theta and phi; of every source with pillars
  bool has_uncertainty = false;
  std::string solver;                 ///< solver_words(), "zero copy"; from a force file its solver
  ContactOptions contacts = {};       ///< for contacts found here
  std::vector<std::string> warnings;  ///< one sentence each
  std::vector<std::string> notes;     ///< likewise
};

/// Produces the fields of a source one by one, in any order. Not thread safe.
class FieldProducer {
 public:
  static constexpr int kMostShown = 6;

  FieldProducer() = default;
  virtual ~FieldProducer() = default;  ///< fields that are alive stay valid
  FieldProducer(const FieldProducer&) = delete;
  FieldProducer& operator=(const FieldProducer&) = delete;

  [[nodiscard]] virtual const SourceInfo& info() const = 0;

  /// Reads or solves frame `index`, pillars always with angles. At most kMostShown fields may be
  /// alive at a time; any thread may destroy them. Throws Error beyond that limit, for a missing
  /// frame, and where reading or solving fails.
  [[nodiscard]] virtual ShownField produce(std::uint64_t index) = 0;

  /// Returns the contacts of the field that was produced last: those stored in the source, else
  /// contacts found now and tracked from earlier calls. Throws Error where reading fails.
  [[nodiscard]] virtual ShownContacts contacts_of(const ShownField& field);

  /// Checks whether a source that is still being written has grown; returns true where
  /// info().frames has changed.
  virtual bool refresh() { return false; }

  /// The total force of a frame where the source stores it.
  [[nodiscard]] virtual std::optional<CurvePoint> stored_total(std::uint64_t index);

  /// Makes another producer of the same source. Each producer belongs to one thread; the function
  /// may be called in any. Of another producer only one field may be alive.
  using Opener = std::function<std::unique_ptr<FieldProducer>()>;
  Opener open_again = {};

 private:
  std::optional<FieldContacts> found_contacts_;
};

/// "direct on DEVICE"; without pillars, which alone have an estimator, "DEVICE".
[[nodiscard]] std::string solver_words(SkinLayout layout, const std::string& estimator,
                                       const std::string& device);

/// Throws Error: kMostShown fields of a producer are alive.
[[noreturn]] void throw_all_fields_in_use();

struct ProducerOptions {
  std::string device = {};  ///< as open_device() takes it
  Memory memory = Memory::automatic;
  PlanOptions plan = {};  ///< of a recording or sensor
  /// Limit on the frames of a scene, which are all simulated beforehand.
  std::uint64_t memory_bytes = std::uint64_t{2} << 30;
  std::uint64_t most_frames = 0;                              ///< of a scene; 0: all
  std::function<void(const std::string&)> on_compiling = {};  ///< as Processor::Options has it
};

/// Opens a scene (.toml), a recording, a Tekscan ASCII export or a file of force fields; the name
/// identifies a scene, the content any other. Frames of the first three are solved with angles, and
/// with uncertainty where the noise is known and the estimator supports it. The baseline is fixed,
/// since frames may come in any order. A frame that directly follows its predecessor uses the
/// friction carried over from it, where the plan has `memory`.
/// `progress` receives fractions 0..1 while a scene is simulated; it may throw to stop. Throws
/// Error where the source cannot be opened or has no frames.
[[nodiscard]] std::unique_ptr<FieldProducer> open_producer(
    const std::filesystem::path& path, const ProducerOptions& options,
    const std::function<void(double)>& progress = {});

/// Frames per second: the inverse of the median step between the times of the first frames; 100
/// where the times do not rise.
[[nodiscard]] double frame_rate(std::uint64_t frames,
                                const std::function<double(std::uint64_t)>& time_of);

}  // namespace pillarfield::viewer
