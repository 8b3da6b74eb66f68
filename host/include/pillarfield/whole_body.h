#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pillarfield/contact_quantities.h"
#include "pillarfield/force_field.h"
#include "pillarfield/processor.h"
#include "pillarfield/scene.h"
#include "pillarfield/solver_plan.h"
#include "pillarfield/stream_format.h"
#include "pillarfield/surface.h"

namespace pillarfield {

/// A patch of a body's skin.
struct BodyPatch {
  std::string name;
  SolverPlan plan;  ///< size, calibration and solver; plan.skin.surface is the patch's own shape
  Pose pose;        ///< of the middle of the patch, in the body's frame
};

inline constexpr std::size_t kMostPatches = 1024;  ///< of a body

/// The skin of a body: patches with a size, pose, calibration and clock of their own.
struct BodySkin {
  std::string title;
  double rate_hz = 1000;   ///< frames of each patch per second
  double refresh_s = 0.1;  ///< time in which a sensor sends every block at least once
  std::vector<BodyPatch> patches;
};

/// What a file says about a body: the skin, and how its sensors are simulated.
struct BodyFile {
  BodySkin skin;
  /// What touches a patch, and its sensor.
  struct Simulated {
    Scene scene;
    double clock_offset_s = 0;   ///< of the sensor's clock from the host's, at the start
    double clock_drift_ppm = 0;  ///< by which it runs fast
  };
  std::vector<Simulated> simulated;  ///< one a patch
};

/// Reads a body (docs/whole_body.md), and its scenes and calibrations, whose paths are relative to
/// the file. Throws Error with file, line, key and the allowed values.
[[nodiscard]] BodyFile load_body(const std::filesystem::path& path);

/// Reads a body from text; `name` stands for its file.
[[nodiscard]] BodyFile parse_body(std::string_view text, const std::filesystem::path& name);

/// Sum of the forces of many pillars, in the body's frame: their force on the skin and its moment
/// about the origin of the body.
struct BodyLoad {
  Wrench wrench;
  double normal_n = 0;  ///< sum of the normal forces; > 0 under pressure
  /// Mean position of the pillars weighted by normal force; unset if normal_n is not above zero.
  std::optional<Vector3> centre_of_pressure_mm;
};

/// What a patch received, and what it did not.
struct PatchHealth {
  std::uint64_t packets = 0;   ///< used
  std::uint64_t blocks = 0;    ///< in these
  std::uint64_t changed = 0;   ///< of these, with readings other than before
  std::uint64_t lost = 0;      ///< packets that did not come, as far as gaps show
  std::uint64_t late = 0;      ///< packets of a frame before the newest; not used
  std::uint64_t restarts = 0;  ///< new sessions, or sequences that began anew
};

/// A patch after WholeBody::solve().
struct PatchState {
  ForceFieldView forces;  ///< of all pillars; valid until the next solve()
  BodyLoad load;
  std::uint64_t sequence = 0;        ///< of the newest frame
  std::uint64_t device_time_ns = 0;  ///< when it was scanned, by the sensor's clock
  /// The same moment by the host's clock (std::steady_clock), from the sensor's clock, whose offset
  /// and drift are followed through the packets that waited least.
  std::chrono::nanoseconds host_time{0};
  /// A packet was lost less than BodySkin::refresh_s ago, or no whole refresh has come yet: blocks
  /// may have readings from before. A sensor that stops sending does not become stale: compare
  /// host_time with the clock.
  bool stale = true;
  PatchHealth health;
};

/// The skin of a body, fed by blocks of sensels that changed (docs/whole_body.md). A solve costs
/// what changed; forces have the same bits as those of whole frames with the same readings.
///
///     WholeBody body(open_device(), skin);
///     body.receive(header, readings, now);  // any number of packets of any patch
///     body.solve();
///     use(body.load(), body.patch(3).forces);
///
/// Threads: one at a time.
class WholeBody {
 public:
  /// Compiles the kernels and allocates all memory, about 20 bytes a sensel; readings begin at
  /// zero. Throws Error if the skin is out of range or the device fails.
  WholeBody(const Device& device, BodySkin skin);
  ~WholeBody();
  WholeBody(WholeBody&&) noexcept;
  WholeBody& operator=(WholeBody&&) noexcept;

  [[nodiscard]] const BodySkin& skin() const;

  /// Takes a packet (docs/stream_format.md) of the patch header.patch: a whole frame, rows or
  /// blocks, which arrived at `arrived` (std::steady_clock). Nothing in it is trusted. Returns
  /// false, and changes nothing, if it contradicts itself or the patch, and counts it in invalid().
  bool receive(const PillarfieldPacket& header, std::span<const std::byte> readings,
               std::chrono::nanoseconds arrived);

  /// Solves the blocks whose readings changed since the last call; the first call solves all. For a
  /// patch whose solve has a memory, such as creep, a call that follows a packet is a frame: call
  /// it once per frame.
  void solve();

  [[nodiscard]] const PatchState& patch(std::size_t index) const;
  /// Sum over all patches, after solve().
  [[nodiscard]] const BodyLoad& load() const;
  /// The readings of a patch as received.
  [[nodiscard]] FrameView readings(std::size_t index) const;
  /// Number of packets that were refused.
  [[nodiscard]] std::uint64_t invalid() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield
