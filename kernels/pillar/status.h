/* The bits of a pillar's status byte (docs/formats.md). */
#define PF_STATUS_SENSEL_1 1   /* upper right sensel usable */
#define PF_STATUS_SENSEL_2 2   /* upper left */
#define PF_STATUS_SENSEL_3 4   /* lower left */
#define PF_STATUS_SENSEL_4 8   /* lower right */
#define PF_STATUS_AMBIGUOUS 16 /* the force is one of a segment, or the region is 1 or 2 */
#define PF_STATUS_SATURATED 32
#define PF_STATUS_INCONSISTENT 64     /* a missing sensel, or contradictory readings */
#define PF_STATUS_FROM_NEIGHBOURS 128 /* ambiguous, and estimated from its contact */

/* At least one sensel is usable or saturated: the pillar is loaded. */
#define PF_STATUS_PRESSED (15 | PF_STATUS_SATURATED)
