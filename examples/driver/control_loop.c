/* A control loop in C99: reads the results of `pillarfield stream ... --to shm:forces`, and prints
 * the total force and how long the contacts will hold about ten times a second, and at once when
 * one is about to slip.
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
  return layout->magic == PILLARFIELD_RING_MAGIC && layout->slots > 1 && layout->slots < 1u << 20 &&
         layout->slot_bytes < 1u << 30 && layout->slot_bytes >= sizeof(PillarfieldResultSlot) &&
         sizeof *layout + layout->slots * layout->slot_bytes <= bytes;
}

/* Ends the program if the ring holds frames, or results of another version of Pillarfield. */
static void check_kind(const PillarfieldRing* layout, const char* name) {
  if (layout->magic != PILLARFIELD_RING_MAGIC || layout->kind == PILLARFIELD_RING_RESULTS ||
      layout->kind == PILLARFIELD_RING_PRESSURES) {
    return;
  }
  fprintf(stderr, "control_loop: shm:%s: %s\n", name + 1,
          layout->kind == PILLARFIELD_RING_FRAMES
              ? "it holds frames, not results; open the ring of stream --to"
              : "its layout is of another version; compile this program with its stream_format.h");
  exit(1);
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
    check_kind(&results->layout, name);
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

/* Replace this by what your robot does. Comparisons with NaN, what is unknown, are false. */
static void act(const PillarfieldResultSlot* result) {
  static double printed = 0;
  static uint64_t alarmed = 0;
  const PillarfieldContact* first = NULL; /* to slip */
  double lowest = INFINITY;
  int alarm;
  uint32_t i;
  for (i = 0; i < result->contacts && i < PILLARFIELD_MAX_CONTACTS; ++i) {
    const PillarfieldContact* contact = &result->contact[i];
    if (contact->slip_margin < lowest) lowest = contact->slip_margin;
    if (contact->time_to_slip_s < (first == NULL ? INFINITY : first->time_to_slip_s)) {
      first = contact;
    }
  }
  alarm = first != NULL && first->slip_within[1] > 0.5;
  if (alarm && first->track_id != alarmed) {
    printf("alarm: contact %llu slips within 0.3 s with a probability of %.0f %%: grip anew\n",
           (unsigned long long)first->track_id, 100 * first->slip_within[1]);
    fflush(stdout);
  }
  alarmed = alarm ? first->track_id : 0;
  if (seconds_now() - printed < 0.1) return;
  printed = seconds_now();
  printf("frame %llu: %.3f N, %u contact%s, lowest slip margin %.2f, ",
         (unsigned long long)result->sequence, result->total.normal_n, result->contacts,
         result->contacts == 1 ? "" : "s", lowest);
  if (first != NULL) {
    printf("slips in %.2f s (%.2f to %.2f), ", first->time_to_slip_s, first->time_to_slip_low_s,
           first->time_to_slip_high_s);
  }
  printf("%.3f ms after its arrival\n", 1e3 * seconds_now() - 1e-6 * (double)result->arrived_ns);
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
