/* Frames of a sensor on their way to Pillarfield, and forces on their way out: the layout of
 * packets and of shared memory, for drivers and control loops in C99 or any other language. Numbers
 * are little-endian, times are nanoseconds. docs/streams.md explains it with examples. */
#ifndef PILLARFIELD_STREAM_FORMAT_H
#define PILLARFIELD_STREAM_FORMAT_H

#include <stdint.h>

#define PILLARFIELD_PACKET_MAGIC 0x31524650u /* "PFR1" */

enum PillarfieldReadingType { PILLARFIELD_U8 = 1, PILLARFIELD_U16 = 2, PILLARFIELD_F32 = 3 };

/* What follows a packet's header. */
enum PillarfieldContent {
  PILLARFIELD_FRAME = 0,  /* all readings, row by row from the top left */
  PILLARFIELD_ROWS = 1,   /* `count` whole rows from row `first` on */
  PILLARFIELD_BLOCKS = 2, /* `count` blocks: a uint32_t block number, 4 zero bytes, 64 readings */
  PILLARFIELD_END = 3     /* nothing: the sensor stops */
};

/* Blocks are 8 x 8 sensels, numbered row by row; those at the right and lower border of the skin
 * may reach beyond it, where their readings are ignored. */
#define PILLARFIELD_BLOCK_SIDE 8u

/* The header of every packet: 64 bytes, then `bytes` of readings. A frame is one packet or several
 * with the same `sequence`, in any order. Sensels that no packet of contents `BLOCKS` names keep
 * their readings: such frames name only blocks that changed. */
typedef struct PillarfieldPacket {
  uint32_t magic;    /* PILLARFIELD_PACKET_MAGIC */
  uint16_t content;  /* PillarfieldContent */
  uint16_t type;     /* PillarfieldReadingType */
  uint32_t rows;     /* sensel rows of the skin */
  uint32_t cols;     /* sensel columns */
  uint64_t session;  /* a number that the driver draws when it starts; 0: none */
  uint64_t sequence; /* of the frame; one more than that of the previous frame */
  uint64_t time_ns;  /* the sensor's clock when it scanned the frame; any origin */
  uint32_t part;     /* of this packet in its frame, from 0 */
  uint32_t parts;    /* packets of the frame, at least 1 */
  uint32_t first;    /* ROWS: the first row */
  uint32_t count;    /* ROWS: rows; BLOCKS: blocks */
  uint32_t patch;    /* 0 */
  uint32_t bytes;    /* after this header */
} PillarfieldPacket;

#endif
