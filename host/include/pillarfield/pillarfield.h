#pragma once

/// @page manual The library in one page
///
/// Pillarfield turns frames of sensel readings into fields of three-axis force.
///
///     #include <pillarfield/pillarfield.h>
///
///     pillarfield::SolverPlan plan;
///     plan.skin.rows = 40;  // sensels
///     plan.skin.cols = 60;
///     plan.skin.counts_per_newton = 320;
///     plan.sensel_type = pillarfield::SenselType::u16;
///     pillarfield::Processor processor(pillarfield::open_device(), plan);
///     processor.submit({readings, plan.sensel_type, 40, 60, 60});
///     pillarfield::ForceFieldView forces = processor.receive();  // 20 x 30 pillars
///
/// The types, in the order of use:
///
/// - Skin: the size of the skin and the constants of its sensels. Four sensels carry a pillar.
/// - Calibration: one plane for each property that differs from sensel to sensel: tare, gain, dead
///   zone, mask, noise. take_tare(), equilibrate(), calibrate_load() and FaultFinder measure them
///   step by step into a SkinCalibration; apply() puts that into a plan.
/// - FrameView, FrameBuffer: one frame of readings, in your memory or in its own.
/// - SolverPlan: the skin, its calibration, the estimator, and what to compute beside forces. The
///   estimator `contact`, the default, remembers the friction of each contact, so that a frame
///   depends on those before it; `direct` solves each frame alone.
/// - Processor solves frames on an OpenCL device, several in flight. solve_on_host() solves one in
///   the calling thread, without OpenCL.
/// - ForceFieldView: the result, a view into the processor. ForceField owns its memory.
/// - status: a byte per pillar says which sensels were usable, and whether the force is ambiguous.
///   region_of() gives the paper's region: 1 and 2 are determined, 3 is ambiguous.
/// - ContactTracker: the contacts of frame after frame, each with its force, torque, centre of
///   pressure, friction and slip, and an id that stays.
/// - Files: open_frames() and RecordingWriter for recordings, create_force_sink() and
///   ForceFileReader for forces, create_contact_sink() for contacts, read_calibration_file() and
///   write_calibration_file().
/// - Simulator makes frames with exact truth from a Scene; Comparison and Coverage measure errors.
///
/// **Units and signs.** Readings are in counts, forces in N, pressures in kPa, lengths in mm, times
/// in s, angles in rad; names say so: `pitch_mm`. Row 0 is the top of the skin (+y), column 0 its
/// left (−x). shear_x (+ right) and shear_y (+ up) are the tangential force on the skin; normal is
/// positive under pressure. theta (from the outward normal) and phi (in the plane,
/// counter-clockwise from +x) give the direction that the force comes from. Torques are
/// counter-clockwise, seen from outside.
///
/// **Ownership.** Types ending in View do not own their memory: a FrameView to the caller's, a
/// ForceFieldView to its Processor's, until that reuses the slot. All other types own what they
/// hold.
///
/// **Errors.** All functions report failure by throwing Error, whose text is one line: where, what
/// failed, how to mend it. The library never prints and never exits.
///
/// **Threads.** One thread at a time may use an object; several threads may use different objects
/// at once, files too if HDF5 is built thread-safe (Debian's is). The exception: the first call of
/// list_devices() or open_device() sets an environment variable.
///
/// **Linking.** `find_package(pillarfield)`, then `pillarfield::pillarfield`; or
/// `pillarfield::core` alone, which needs neither OpenCL nor HDF5, with `pillarfield::io` (HDF5)
/// for files.

// Frames and solvers.
#include "pillarfield/calibration.h"
#include "pillarfield/error.h"
#include "pillarfield/force_field.h"
#include "pillarfield/frame.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/pressure_unit.h"
#include "pillarfield/processor.h"
#include "pillarfield/sensor_effects.h"
#include "pillarfield/skin.h"
#include "pillarfield/solver_plan.h"
#include "pillarfield/status.h"
#include "pillarfield/surface.h"
#include "pillarfield/version.h"

// Contacts.
#include "pillarfield/component_ends.h"
#include "pillarfield/contact_tracker.h"
#include "pillarfield/friction.h"

// Files.
#include "pillarfield/calibration_file.h"
#include "pillarfield/contact_file.h"
#include "pillarfield/force_file.h"
#include "pillarfield/recording.h"

// Calibration of a new skin.
#include "pillarfield/arm_calibration.h"
#include "pillarfield/bending_calibration.h"
#include "pillarfield/doctor.h"
#include "pillarfield/equilibration.h"
#include "pillarfield/fault_finder.h"
#include "pillarfield/leak_calibration.h"
#include "pillarfield/load_calibration.h"
#include "pillarfield/memory_calibration.h"
#include "pillarfield/shear_calibration.h"
#include "pillarfield/skin_calibration.h"
#include "pillarfield/tare.h"
#include "pillarfield/untouched_skin.h"
#include "pillarfield/weight_calibration.h"
#include "pillarfield/wire_calibration.h"

// Simulation and its comparison with the truth.
#include "pillarfield/comparison.h"
#include "pillarfield/coverage.h"
#include "pillarfield/resultant_comparison.h"
#include "pillarfield/scene.h"
#include "pillarfield/simulator.h"
