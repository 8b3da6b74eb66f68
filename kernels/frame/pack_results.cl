/* Packs the results that the host lacks, for devices with their own memory. A program of its own.
 *
 * Pillars form groups of 64 in their row-by-row order; the last group may lack some. A group is
 * packed if a bit of it differs from `sent`, the results that the host has, or if one of its
 * pillars is ambiguous: the host may have resolved that one in its copy. `packed` begins with the
 * number of groups in 64 bytes, zero before the launch; groups follow in any order: index in 16
 * bytes, 64 values of each plane, 64 status bytes (host/device/packed_results.cpp). A work-item a
 * pillar, a work-group a group. */

#define PF_GROUP 64

kernel __attribute__((reqd_work_group_size(PF_GROUP, 1, 1))) void pack_results(
    global const uchar* results, global uchar* sent, global uint* packed, ulong plane_bytes,
    uint planes, uint pillars, uint ambiguous) {
  local uint number; /* of the group among the packed ones, from 1 on; 0: it is not packed */
  const uint lane = get_local_id(0);
  const size_t pillar = get_global_id(0);
  const bool exists = pillar < pillars;
  const size_t status = planes * plane_bytes + pillar;
  if (lane == 0) number = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  if (exists) {
    bool differs = results[status] != sent[status] || (results[status] & ambiguous) != 0;
    for (uint plane = 0; plane < planes; ++plane) {
      differs |= ((global const uint*)(results + plane * plane_bytes))[pillar] !=
                 ((global const uint*)(sent + plane * plane_bytes))[pillar];
    }
    if (differs) number = 1;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  if (lane == 0 && number != 0) number = 1 + atomic_inc(packed);
  barrier(CLK_LOCAL_MEM_FENCE);
  if (number == 0 || !exists) return;
  const size_t words = 4 + PF_GROUP * planes + PF_GROUP / 4;
  global uint* const group = packed + 16 + (number - 1) * words;
  global uint* const values = group + 4;
  if (lane == 0) group[0] = get_group_id(0);
  for (uint plane = 0; plane < planes; ++plane) {
    const uint value = ((global const uint*)(results + plane * plane_bytes))[pillar];
    ((global uint*)(sent + plane * plane_bytes))[pillar] = value;
    values[plane * PF_GROUP + lane] = value;
  }
  sent[status] = results[status];
  ((global uchar*)(values + planes * PF_GROUP))[lane] = results[status];
}
