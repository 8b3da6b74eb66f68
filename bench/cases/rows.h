#pragma once

#include "bench/session.h"

namespace pillarfield::bench {

// Each adds the rows of some groups; the session must outlive them. docs/benchmark.md says what
// they mean.

void add_ceiling_rows(const Session& session);   ///< ceiling/
void add_size_rows(const Session& session);      ///< size/, contact/, regions/
void add_plan_rows(const Session& session);      ///< type/, output/, estimator/, lanes/, stage/
void add_time_rows(const Session& session);      ///< latency/, throughput/
void add_opponent_rows(const Session& session);  ///< opponent/
void add_by_hand_rows(const Session& session);   ///< by_hand/
void add_spread_rows(const Session& session);    ///< spread/
void add_variant_rows(const Session& session);   ///< variant/
void add_field_rows(const Session& session);     ///< field/
void add_render_rows(const Session& session);    ///< render/

}  // namespace pillarfield::bench
