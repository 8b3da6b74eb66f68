/* A control loop in C99: reads the results of `pillarfield stream ... --to shm:forces`, and prints
 * the total force and the lowest slip margin about ten times a second.
 *
 *     cc -O2 -o control_loop control_loop.c        with pillarfield/stream_format.h on the path
 *     ./control_loop forces --seconds 10 */
#define _DEFAULT_SOURCE
#include <fcntl.h>
#include <linux/futex.h>
#include <math.h>
#include <pillarfield/stream_format.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

/* --- The ring -------------------------------------------------------------------------------- */

typedef struct Results {
  const PillarfieldRing* ring; /* null: closed */
  PillarfieldRing layout;      /* a copy, which nobody changes */
  size_t bytes;
  int segment;
  uint64_t next; /* number of the next result */
} Results;

static void close_results(Results* results) {
  if (results->ring != NULL) munmap((void*)results->ring, results->bytes);
  if (results->segment >= 0) close(results->segment);
  results->ring = NULL;
}

static int is_valid(const PillarfieldRing* layout, size_t bytes) {
  return layout->magic == PILLARFIELD_RING_MAGIC && layout->kind == PILLARFIELD_RING_RESULTS &&
         layout->slots > 1 && layout->slots < 1u << 20 && layout->slot_bytes < 1u << 30 &&
         layout->slot_bytes >= sizeof(PillarfieldResultSlot) &&
         sizeof *layout + layout->slots * layout->slot_bytes <= bytes;
}

/* Opens the ring `name`, if there is one of this user or root. */
static void open_results(Results* results, const char* name) {
  struct stat status;
  void* memory = MAP_FAILED;
  memset(results, 0, sizeof *results);
  results->segment = shm_open(name, O_RDONLY, 0);
  if (results->segment >= 0 && fstat(results->segment, &status) == 0 &&
      (status.st_uid == geteuid() || status.st_uid == 0) &&
      (size_t)status.st_size > sizeof results->layout) {
    results->bytes = (size_t)status.st_size;
    memory = mmap(NULL, results->bytes, PROT_READ, MAP_SHARED, results->segment, 0);
  }
  if (memory != MAP_FAILED) {
    results->ring = memory;
    results->layout = *results->ring;
    results->next = results->layout.published;
    if (is_valid(&results->layout, results->bytes)) return;
  }
  close_results(results);
}

/* Whether the ring's writer has ended, or another ring has its name. */
static int is_over(const Results* results) {
  struct stat status;
  return __atomic_load_n(&results->ring->closed, __ATOMIC_ACQUIRE) ||
         fstat(results->segment, &status) != 0 || status.st_nlink == 0;
}

/* Waits up to 0.1 s for the next result and copies the head of its slot; 1 if there is one. A loop
 * that fell behind goes on with the newest. */
static int read_result(Results* results, PillarfieldResultSlot* copy) {
  const PillarfieldRing* ring = results->ring;
  const PillarfieldRing* layout = &results->layout;
  const struct timespec wait = {0, 100000000};
  const uint32_t signal = __atomic_load_n(&ring->signal, __ATOMIC_ACQUIRE);
  uint64_t published = __atomic_load_n(&ring->published, __ATOMIC_ACQUIRE);
  const PillarfieldResultSlot* slot;
  if (published <= results->next) {
    syscall(SYS_futex, &ring->signal, FUTEX_WAIT, signal, &wait, NULL, 0);
    published = __atomic_load_n(&ring->published, __ATOMIC_ACQUIRE);
    if (published <= results->next) return 0;
  }
  if (published - results->next >= layout->slots) results->next = published - 1;
  slot = (const PillarfieldResultSlot*)((const char*)(ring + 1) +
                                        results->next % layout->slots * layout->slot_bytes);
  memcpy(copy, slot, sizeof *copy);
  __atomic_thread_fence(__ATOMIC_ACQUIRE);
  return __atomic_load_n(&slot->lock, __ATOMIC_RELAXED) == 2 * results->next++ + 2;
}

/* --- The loop -------------------------------------------------------------------------------- */

static double seconds_now(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Replace this by what your robot does. */
static void act(const PillarfieldResultSlot* result) {
  static double printed = 0;
  double lowest = INFINITY;
  uint32_t i;
  for (i = 0; i < result->contacts && i < PILLARFIELD_MAX_CONTACTS; ++i) {
    const double margin = result->contact[i].slip_margin;
    if (margin < lowest) lowest = margin; /* false for NaN, an unknown margin */
  }
  if (seconds_now() - printed < 0.1) return;
  printed = seconds_now();
  printf("frame %llu: %.3f N, %u contacts, lowest slip margin %.2f, %.3f ms after its arrival\n",
         (unsigned long long)result->sequence, result->total.normal_n, result->contacts, lowest,
         1e3 * seconds_now() - 1e-6 * (double)result->arrived_ns);
  fflush(stdout);
}

int main(int count, char** words) {
  const double seconds = count == 4 && strcmp(words[2], "--seconds") == 0 ? atof(words[3]) : 10;
  const double end = seconds_now() + seconds;
  PillarfieldResultSlot result;
  Results results;
  char path[256];
  if (count != 2 && count != 4) {
    fprintf(stderr, "Usage: control_loop NAME [--seconds S]\n");
    return 2;
  }
  snprintf(path, sizeof path, "/%s", words[1]);
  open_results(&results, path);
  while (seconds_now() < end) {
    if (results.ring == NULL) {
      usleep(10000);
      open_results(&results, path);
    } else if (read_result(&results, &result)) {
      act(&result);
    } else if (is_over(&results)) {
      close_results(&results);
    }
  }
  return 0;
}
