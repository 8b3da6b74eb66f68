/* Frames of a sensor on their way to Pillarfield, and forces on their way out: the layout of
 * packets and of shared memory, for drivers and control loops in C99 or any other language. Numbers
 * are little-endian, times are nanoseconds. docs/streams.md explains it with examples. */
#ifndef PILLARFIELD_STREAM_FORMAT_H
#define PILLARFIELD_STREAM_FORMAT_H

/* NOLINTBEGIN(modernize-use-using, modernize-deprecated-headers): it is C. */
#include <stdint.h>

#define PILLARFIELD_PACKET_MAGIC 0x31524650u /* "PFR1" */

enum PillarfieldReadingType { PILLARFIELD_U8 = 1, PILLARFIELD_U16 = 2, PILLARFIELD_F32 = 3 };

/* The content after a packet's header. */
enum PillarfieldContent {
  PILLARFIELD_FRAME = 0,     /* all readings, row by row from the top left */
  PILLARFIELD_ROWS = 1,      /* `count` whole rows from row `first` on */
  PILLARFIELD_CONSTANTS = 2, /* nothing: the header states constants, beside packets of ROWS */
  PILLARFIELD_END = 3        /* nothing: the sensor stops */
};

/* The structure on the sensels. */
enum PillarfieldLayout {
  PILLARFIELD_LAYOUT_NOT_STATED = 0,
  PILLARFIELD_PILLARS = 1, /* a pillar on each 2 x 2 */
  PILLARFIELD_SENSELS = 2  /* nothing: each sensel by itself */
};

/* `first` of FRAME and CONSTANTS: the layout, and the pitch of the sensels in mm, 0 or 1e-3 to 1e3;
 * 0: not stated. */
#ifdef __cplusplus
#define PILLARFIELD_UINT32(value) static_cast<uint32_t>(value)
#else
#define PILLARFIELD_UINT32(value) ((uint32_t)(value))
#endif
#define PILLARFIELD_STATED(layout, pitch_mm) \
  (PILLARFIELD_UINT32(layout) << 30 | PILLARFIELD_UINT32((pitch_mm)*1e6 + 0.5))

/* Added to `content`: the packet ends with a uint32_t, counted in `bytes`, the CRC-32 (of zlib,
 * zip, Ethernet) of all bytes before it, header included. For serial lines, which have none of
 * their own. */
#define PILLARFIELD_CHECKED 0x100u

/* The header of every packet: 64 bytes, then `bytes` of readings. A frame is one packet or several
 * with the same `sequence`, in any order. */
typedef struct PillarfieldPacket {
  uint32_t magic;    /* PILLARFIELD_PACKET_MAGIC */
  uint16_t content;  /* PillarfieldContent */
  uint16_t type;     /* PillarfieldReadingType */
  uint32_t rows;     /* sensel rows of the skin */
  uint32_t cols;     /* sensel columns */
  uint64_t session;  /* a number that the driver draws when it starts; 0: none */
  uint64_t sequence; /* of the frame; one more than that of the previous frame */
  uint64_t time_ns;  /* the sensor's clock when it scanned the frame, any origin; 0: none */
  uint32_t part;     /* of this packet in its frame, from 0 */
  uint32_t parts;    /* packets of the frame, at least 1 */
  uint32_t first;    /* ROWS: the first row; FRAME, CONSTANTS: PILLARFIELD_STATED() or 0 */
  uint32_t count;    /* ROWS: how many; FRAME, CONSTANTS: counts per newton as a float, or 0 */
  uint32_t patch;    /* 0 */
  uint32_t bytes;    /* after this header */
} PillarfieldPacket;

/* Limits of what is accepted. */
#define PILLARFIELD_MAX_SENSELS (1u << 24) /* of a frame */
#define PILLARFIELD_MAX_PARTS (1u << 16)   /* of a frame */

/* A ring in POSIX shared memory, `/NAME` of shm_open(): a PillarfieldRing, then `slots` slots of
 * `slot_bytes`. One process writes it, any number read it and never delay the writer.
 *
 * To publish number n (0, 1, ...) in the slot n % slots: set `lock` to 2n + 1, write the content,
 * set `lock` to 2n + 2, `published` to n + 1 and `signal` to its lower 32 bits, then wake all who
 * wait for `signal` (futex, not private). To read it: wait until `published` is above n, copy the
 * content, and use the copy if `lock` is still 2n + 2. `lock`, `published`, `signal` and `closed`
 * are atomic; a store releases, a load acquires.
 *
 * A writer creates the segment with mode 0600, locks it with flock() while it lives, sets `magic`
 * last, and in the end sets `closed`, wakes and unlinks. One that starts where another was killed
 * goes on with a segment of the layout that it needs, from `published` on, unlinks another ring,
 * and refuses what is not a ring.
 */
#define PILLARFIELD_RING_MAGIC 0x31475250u /* "PRG1" */

/* A reader refuses other kinds. 2 to 5 are results of earlier versions, in other layouts. */
enum PillarfieldRingKind {
  PILLARFIELD_RING_FRAMES = 1,
  PILLARFIELD_RING_RESULTS = 6,  /* of pillars */
  PILLARFIELD_RING_PRESSURES = 7 /* results of sensels without pillars */
};

typedef struct PillarfieldRing {
  uint32_t magic; /* PILLARFIELD_RING_MAGIC */
  uint32_t kind;  /* PillarfieldRingKind */
  uint32_t rows;  /* of sensels; in RING_RESULTS of pillars */
  uint32_t cols;
  /* PillarfieldReadingType; of results 0, or the bits of a float: mm from one row to the next,
   * where that is not pitch_mm */
  uint32_t type;
  uint32_t slots;      /* at least 2 */
  uint64_t slot_bytes; /* from one slot to the next, a multiple of 64 */
  uint64_t session;    /* a number that the writer draws when it starts */
  uint64_t published;  /* how many were published; the newest has the number published - 1 */
  uint32_t signal;     /* the lower 32 bits of `published` */
  uint32_t closed;     /* 1: the writer has ended */
  double pitch_mm; /* of results: from one pillar, or sensel, to the next in a row; of frames 0 */
} PillarfieldRing;

/* Constants of the skin; 0: not stated. */
typedef struct PillarfieldConstants {
  uint32_t layout;   /* PillarfieldLayout */
  uint32_t mirrored; /* 1: readings that fall under load, as full scale less the reading */
  double pitch_x_mm; /* from one column of sensels to the next */
  double pitch_y_mm; /* from one row to the next */
  double counts_per_newton;
  double threshold_counts;
  double full_scale_counts;
  double reserved;
} PillarfieldConstants;

/* A slot of frames: this, then all readings, row by row from the top left. */
typedef struct PillarfieldFrameSlot {
  uint64_t lock;
  PillarfieldConstants constants;
  PillarfieldPacket packet; /* content FRAME */
} PillarfieldFrameSlot;

#define PILLARFIELD_MAX_CONTACTS 64u

enum PillarfieldSlip {
  PILLARFIELD_SLIP_UNKNOWN = 0,
  PILLARFIELD_STICKING = 1,
  PILLARFIELD_PARTIAL_SLIP = 2,
  PILLARFIELD_SLIDING = 3
};

enum PillarfieldFrictionSource {
  PILLARFIELD_FRICTION_UNKNOWN = 0,
  PILLARFIELD_FRICTION_GIVEN = 1,
  PILLARFIELD_FRICTION_OBSERVED = 2,     /* by the pillars of this frame */
  PILLARFIELD_FRICTION_CARRIED_OVER = 3, /* from earlier frames */
  PILLARFIELD_FRICTION_AT_LEAST = 4      /* a lower bound, in 19 of 20 cases */
};

/* Forces act on the skin: x right, y up, normal positive under pressure. Places are in mm from the
 * centre of the patch. NaN: unknown. docs/contacts_found.md defines each quantity. */
typedef struct PillarfieldContact {
  uint64_t track_id; /* 1, 2, ...; never reused */
  uint64_t pillars;  /* in contact, or sensels */
  uint64_t ambiguous;
  uint64_t resolved;        /* of the ambiguous */
  uint32_t label;           /* its number among the connected parts of the loaded pillars */
  uint32_t slip;            /* PillarfieldSlip */
  uint32_t friction_source; /* PillarfieldFrictionSource */
  uint32_t reserved;        /* 0 */
  double first_time_s;      /* time_s of its first frame */
  double shear_x_n;
  double shear_y_n;
  double normal_n;
  double torque_nmm;  /* about the outward normal through the centre of pressure */
  double centre_x_mm; /* centre of pressure */
  double centre_y_mm;
  double middle_x_mm; /* mean place of its pillars */
  double middle_y_mm;
  double area_mm2;
  double peak_n; /* the largest normal force of a pillar */
  double peak_x_mm;
  double peak_y_mm;
  double friction;           /* coefficient */
  double friction_deviation; /* its standard deviation; NaN too if it was given */
  double slip_margin;        /* 1 - |shear| / (friction * normal) */
  double slipping_share;     /* part of the normal force on pillars that slip */
  /* Until the whole contact slides at the present rates, with a 95 % interval; infinite: never. */
  double time_to_slip_s;
  double time_to_slip_low_s;
  double time_to_slip_high_s;
  double slip_within[3]; /* probability of that within 0.1, 0.3 and 1 s */
  double unseen;         /* share of its area over missing or masked sensels */
  /* Standard deviations by what is unseen. */
  double normal_deviation_n;
  double shear_x_deviation_n;
  double shear_y_deviation_n;
  double centre_x_deviation_mm;
  double centre_y_deviation_mm;
  double torque_deviation_nmm;
} PillarfieldContact;

/* A slot of results: this, then planes [rows, cols] one after the other, row by row from the top
 * left: shear_x, shear_y and normal as float in N, and the status bytes (pillarfield/status.h);
 * without pillars there is no shear: normal and status. */
typedef struct PillarfieldResultSlot {
  uint64_t lock;
  uint64_t sequence;        /* of the frame */
  double time_s;            /* the sensor's clock, from the first frame on */
  uint64_t arrived_ns;      /* CLOCK_MONOTONIC when the frame had arrived */
  uint64_t arrived_unix_ns; /* CLOCK_REALTIME then */
  uint64_t published_ns;    /* CLOCK_MONOTONIC when the result was published */
  uint32_t missing;         /* 1: readings of the frame did not arrive */
  uint32_t contacts;        /* valid elements of `contact` */
  uint64_t contacts_found;  /* may be more */
  PillarfieldContact total; /* of all loaded pillars; track_id 0 */
  PillarfieldContact contact[PILLARFIELD_MAX_CONTACTS]; /* the strongest, by normal force */
} PillarfieldResultSlot;
/* NOLINTEND(modernize-use-using, modernize-deprecated-headers) */

#endif
