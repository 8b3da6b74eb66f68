/* The one table of the stages and that of their constants: host/solve/stages.cpp evaluates it for a
 * plan, stages.h makes the struct of C++ from it, and a program's first lines are made from it. */

/* The stages, in their order. X(name, macro, place, keeps state, named):
 *   macro  defined in programs with the stage; none: every program has it
 *   place  pillar: stages.h, in solve_frame.cl; frame: an entry point of its own in kernels/frame,
 *          which reads the frame; host: after the device, reads the frame's results
 *   named  whether the SolverPlan `plan` names it; `effects` are those of its calibration */
#define PF_STAGES(X)                                                                               \
  X(load, none, pillar, false, true)                                                               \
  X(reject_out_of_range, PF_RANGE, pillar, false, plan.sensel_type == SenselType::f32)             \
  X(mask, PF_MASK, pillar, false, !plan.calibration.mask.empty())                                  \
  X(saturation, PF_SATURATION, pillar, false, plan.skin.full_scale_counts.has_value())             \
  X(wires, PF_WIRES, frame, false, effects.wires.has_value())                                      \
  X(bend, PF_BEND, frame, true, !plan.calibration.bend_x.empty())                                  \
  X(tare, PF_TARE, pillar, false,                                                                  \
    !plan.calibration.tare.empty() || plan.baseline_rate || !plan.calibration.bend_x.empty())      \
  X(wires_after_tare, PF_WIRES_AFTER_TARE, pillar, false, has_offset_tares(effects))               \
  X(gain, PF_GAIN, pillar, false, !plan.calibration.gain.empty())                                  \
  X(power_law, PF_POWER_LAW, pillar, false, plan.skin.power_law.has_value())                       \
  X(curve, PF_CURVE, pillar, false, !effects.curve.empty())                                        \
  X(leak, PF_LEAK, pillar, false, effects.sensel_leak.has_value())                                 \
  X(memory, PF_MEMORY, pillar, true, effects.memory.has_value())                                   \
  X(classify, none, pillar, false, true)                                                           \
  X(dead_zone, PF_DEAD_ZONE, pillar, false, !plan.calibration.dead_zone.empty())                   \
  X(sensel_force, PF_SENSELS, pillar, false, !plan.skin.has_pillars())                             \
  X(direct_solve, none, pillar, false,                                                             \
    plan.skin.has_pillars() && plan.estimator != Estimator::paper)                                 \
  X(paper_solve, PF_PAPER, pillar, false, plan.estimator == Estimator::paper)                      \
  X(shear_coefficient, PF_SHEAR_COEFFICIENT, pillar, false, effects.shear_coefficient.has_value()) \
  X(residual, PF_RESIDUAL, pillar, false, effects.residual.has_value())                            \
  X(parity_test, PF_PARITY_TEST, pillar, false, plan.parity_tolerance_counts.has_value())          \
  X(angles, PF_ANGLES, pillar, false, plan.angles)                                                 \
  X(uncertainty, PF_UNCERTAINTY, pillar, false, plan.uncertainty)                                  \
  X(store, none, pillar, false, true)                                                              \
  X(pillar_leak, PF_PILLAR_LEAK, frame, false, effects.pillar_leak.has_value())                    \
  X(lean, PF_LEAN, frame, false, effects.arm_mm.has_value())                                       \
  X(shear_ratio, none, frame, false, effects.arm_mm.has_value())                                   \
  X(follow_baseline, PF_BASELINE, frame, true, plan.baseline_rate.has_value())                     \
  X(estimate_contacts, none, host, true, estimator_of(plan) == Estimator::contact)

/* Numbers of the stages. X(name, needed, kind, value):
 *   needed  by the stages `is`
 *   kind    exact, or in a program of whole numbers: above, a limit of x > value; from, one of
 *           x >= value; per_count, newtons per unit; fraction, n of 1 - 1 / 2^n
 *   value   of the plan, by host/solve/stages.cpp */
#define PF_STAGE_CONSTANTS(X)                                                                   \
  /* Counts; readings beyond, and NaN, are missing. */                                          \
  X(largest, is.reject_out_of_range || is.power_law, exact, kMaxCounts)                         \
  X(full_scale, is.saturation, from, plan.skin.full_scale_counts.value_or(0))                   \
  X(exponent, is.power_law, exact, power_law.exponent)                                          \
  X(reference, is.power_law, exact, power_law.reference_counts)                                 \
  /* LeakTaps */                                                                                \
  X(leak_self, is.leak, exact, leak.self)                                                       \
  X(leak_inside, is.leak, exact, leak.inside)                                                   \
  X(leak_across, is.leak, exact, leak.across)                                                   \
  X(leak_both_inside, is.leak, exact, leak.both_inside)                                         \
  X(leak_mixed, is.leak, exact, leak.mixed)                                                     \
  X(leak_both_across, is.leak, exact, leak.both_across)                                         \
  /* Counts; the margin is that of D9 (docs/derivations/direct_solve.md). */                    \
  X(threshold, true, above, plan.skin.threshold_counts)                                         \
  X(margin, true, from, region_margin(plan))                                                    \
  X(parity_tolerance, is.parity_test, above, plan.parity_tolerance_counts.value_or(0))          \
  X(segment_point, true, fraction, plan.segment_point)                                          \
  /* Newtons per count (ForceScale). */                                                         \
  X(shear_scale, true, per_count, scale.shear)                                                  \
  X(normal_scale, true, per_count, scale.normal)                                                \
  X(per_coefficient_x, is.shear_coefficient, exact, 1 / coefficient.x)                          \
  X(per_coefficient_y, is.shear_coefficient, exact, 1 / coefficient.y)                          \
  X(residual_relative, is.residual, exact, residual.relative)                                   \
  X(residual_variance, is.residual, exact, residual_variance)                                   \
  X(relative_margin, is.residual, exact, region_margin(residual.relative)) /* of the reading */ \
  /* Noise of a raw reading, counts, unless the calibration has that of each sensel. */         \
  X(noise, is.uncertainty, exact, reading_noise(plan))                                          \
  /* Weights of the inverse of a leak between pillars. */                                       \
  X(pillar_leak_self, is.pillar_leak, exact, pillar_leak.self)                                  \
  X(pillar_leak_edge, is.pillar_leak, exact, pillar_leak.edge)                                  \
  X(pillar_leak_corner, is.pillar_leak, exact, pillar_leak.corner)                              \
  X(pitch_over_arm, is.lean, exact, plan.skin.pillar_pitch_mm() / effects.arm_mm.value_or(1))   \
  /* Per count (WireCrosstalk). */                                                              \
  X(row_per_count, is.wires, exact, wires.row_per_count)                                        \
  X(column_per_count, is.wires, exact, wires.column_per_count)                                  \
  X(idle_per_count, is.wires, exact, wires.idle_per_count)                                      \
  /* Counts (ActivationRange); the threshold of all sensels, where they do not differ. */       \
  X(activation, !has_activation_plane(plan), exact, of_all)                                     \
  X(activation_cut, true, exact, activation.threshold)                                          \
  X(activation_step, true, exact, activation.step)                                              \
  X(activation_lowest, true, exact, activation.lowest)                                          \
  X(activation_highest, true, exact, activation.highest)                                        \
  X(activation_never, true, exact, activation.never)                                            \
  /* The most that an idle sensel reads above its tare. */                                      \
  X(idle_load, is.wires_after_tare, exact, idle_load(plan))
