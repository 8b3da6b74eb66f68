/* A driver in C99: writes the frames of a pressed spot that moves into a ring in shared memory.
 *
 *     cc -O2 -o ring_driver ring_driver.c          with pillarfield/stream_format.h on the path
 *     ./ring_driver skin --rate 1000 --seconds 10 &
 *     pillarfield stream shm:skin
 *
 * Copy the first half, and replace scan() by what reads your sensor. */
#define _DEFAULT_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <linux/futex.h>
#include <pillarfield/stream_format.h>
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

/* --- The ring -------------------------------------------------------------------------------- */

static void fail(const char* what) {
  perror(what);
  exit(1);
}

/* Opens the ring `name` for 8-bit frames: goes on with that of a driver that was killed if it has
 * this size, and replaces any other. */
static PillarfieldRing* open_ring(const char* name, uint32_t rows, uint32_t cols) {
  PillarfieldRing wanted = {
      PILLARFIELD_RING_MAGIC, PILLARFIELD_RING_FRAMES, 0, 0, PILLARFIELD_U8, 64, 0, 0, 0, 0, 0, 0};
  size_t bytes;
  wanted.rows = rows;
  wanted.cols = cols;
  wanted.slot_bytes = (sizeof(PillarfieldFrameSlot) + (uint64_t)rows * cols + 63) / 64 * 64;
  bytes = sizeof wanted + wanted.slots * wanted.slot_bytes;
  for (;;) {
    struct stat status;
    PillarfieldRing* ring = NULL;
    const int segment = shm_open(name, O_RDWR | O_CREAT, 0600);
    if (segment < 0 || fstat(segment, &status) != 0) fail(name);
    if (status.st_uid != geteuid()) {
      errno = EPERM;
      fail("this ring belongs to another user");
    }
    if (flock(segment, LOCK_EX | LOCK_NB) != 0) fail("another driver writes this ring");
    if (status.st_size == 0 || (size_t)status.st_size == bytes) {
      if (posix_fallocate(segment, 0, (off_t)bytes) != 0) fail(name);
      ring = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, segment, 0);
      if (ring == MAP_FAILED) fail(name);
      if (status.st_size == 0)
        memcpy(&ring->kind, &wanted.kind, sizeof wanted - sizeof wanted.magic);
      if (status.st_size == 0) __atomic_store_n(&ring->magic, wanted.magic, __ATOMIC_RELEASE);
    }
    if (ring != NULL && memcmp(ring, &wanted, offsetof(PillarfieldRing, session)) == 0) {
      ring->session = (uint64_t)time(NULL) << 32 | (uint64_t)getpid();
      __atomic_store_n(&ring->closed, 0, __ATOMIC_RELEASE);
      return ring; /* `segment` stays open, and so locked, while the driver lives. */
    }
    shm_unlink(name);
    close(segment);
  }
}

static PillarfieldFrameSlot* begin_frame(PillarfieldRing* ring) {
  const uint64_t number = ring->published;
  PillarfieldFrameSlot* slot =
      (PillarfieldFrameSlot*)((char*)(ring + 1) + number % ring->slots * ring->slot_bytes);
  __atomic_store_n(&slot->lock, 2 * number + 1, __ATOMIC_RELAXED);
  __atomic_thread_fence(__ATOMIC_RELEASE);
  return slot;
}

static void wake_readers(PillarfieldRing* ring) {
  syscall(SYS_futex, &ring->signal, FUTEX_WAKE, INT_MAX, NULL, NULL, 0);
}

static void publish_frame(PillarfieldRing* ring, PillarfieldFrameSlot* slot) {
  const uint64_t number = ring->published;
  __atomic_store_n(&slot->lock, 2 * number + 2, __ATOMIC_RELEASE);
  __atomic_store_n(&ring->published, number + 1, __ATOMIC_RELEASE);
  __atomic_store_n(&ring->signal, (uint32_t)(number + 1), __ATOMIC_RELEASE);
  wake_readers(ring);
}

static void close_ring(PillarfieldRing* ring, const char* name) {
  __atomic_store_n(&ring->closed, 1, __ATOMIC_RELEASE);
  wake_readers(ring);
  shm_unlink(name);
}

/* --- The sensor ------------------------------------------------------------------------------ */

static volatile sig_atomic_t stopped = 0;

static void stop(int signal_number) {
  (void)signal_number;
  stopped = 1;
}

static uint64_t now_ns(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

/* A spot of 5 sensels radius that crosses the skin in 1000 frames. */
static void scan(uint8_t* readings, uint32_t rows, uint32_t cols, uint64_t frame) {
  const int middle_row = (int)(rows / 2), middle_col = (int)(frame % 1000 * cols / 1000);
  int row, col;
  memset(readings, 0, (size_t)rows * cols);
  for (row = middle_row - 5; row <= middle_row + 5; ++row) {
    for (col = middle_col - 5; col <= middle_col + 5; ++col) {
      const int square =
          (row - middle_row) * (row - middle_row) + (col - middle_col) * (col - middle_col);
      if (row < 0 || col < 0 || row >= (int)rows || col >= (int)cols || square > 25) continue;
      readings[(size_t)row * cols + (size_t)col] = (uint8_t)(200 - 6 * square);
    }
  }
}

int main(int count, char** words) {
  const char* name = NULL;
  double rate = 100, seconds = 10;
  uint32_t rows = 64, cols = 64;
  char path[256];
  PillarfieldRing* ring;
  uint64_t frame, start;
  int i;
  for (i = 1; i < count; ++i) {
    const char* value = i + 1 < count ? words[i + 1] : "";
    if (strcmp(words[i], "--rate") == 0)
      rate = atof(value), ++i;
    else if (strcmp(words[i], "--seconds") == 0)
      seconds = atof(value), ++i;
    else if (strcmp(words[i], "--rows") == 0)
      rows = (uint32_t)atoi(value), ++i;
    else if (strcmp(words[i], "--cols") == 0)
      cols = (uint32_t)atoi(value), ++i;
    else
      name = words[i];
  }
  if (name == NULL || rate <= 0 || rows < 2 || cols < 2 || rows > 4096 || cols > 4096) {
    fprintf(stderr, "Usage: ring_driver NAME [--rate HZ] [--seconds S] [--rows N] [--cols N]\n");
    return 2;
  }
  signal(SIGINT, stop);
  signal(SIGTERM, stop);
  snprintf(path, sizeof path, "/%s", name);
  ring = open_ring(path, rows, cols);
  start = now_ns();
  for (frame = 0; !stopped && (double)frame < rate * seconds; ++frame) {
    PillarfieldFrameSlot* slot = begin_frame(ring);
    const PillarfieldPacket packet = {PILLARFIELD_PACKET_MAGIC,
                                      PILLARFIELD_FRAME,
                                      PILLARFIELD_U8,
                                      rows,
                                      cols,
                                      ring->session,
                                      frame,
                                      now_ns(),
                                      0,
                                      1,
                                      0,
                                      0,
                                      0,
                                      rows * cols};
    const uint64_t due = start + (uint64_t)((double)(frame + 1) * 1e9 / rate);
    slot->packet = packet;
    scan((uint8_t*)(slot + 1), rows, cols, frame);
    publish_frame(ring, slot);
    if (due > now_ns()) {
      const uint64_t wait = due - now_ns();
      const struct timespec pause = {(time_t)(wait / 1000000000u), (long)(wait % 1000000000u)};
      nanosleep(&pause, NULL);
    }
  }
  close_ring(ring, path);
  return 0;
}
