/* Measures the latency of `pillarfield stream` from outside: sends frames at a fixed rate into its
 * source, waits for their results at a sink, and prints, as JSON, how long they took and how many
 * came. It uses the formats alone (pillarfield/stream_format.h), not the library.
 *
 *     live_latency shm:frames shm:forces --rate 1000 --seconds 60
 *     pillarfield stream shm:frames --to shm:forces
 */
#define _GNU_SOURCE
#include <arpa/inet.h>
#include <fcntl.h>
#include <limits.h>
#include <linux/futex.h>
#include <pillarfield/stream_format.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

typedef struct Options {
  const char* in;
  const char* out;
  double rate;
  double seconds;
  uint32_t rows;
  uint32_t cols;
} Options;

static Options options = {.rate = 1000, .seconds = 10, .rows = 158, .cols = 158};
static uint64_t frames;
static uint64_t* sent_ns;
static uint64_t* latency_ns;                    /* 0: not received */
static atomic_uint_fast64_t first = UINT64_MAX; /* sequence of the first frame that is measured */
static atomic_uint_fast64_t received, twice;
static atomic_bool started, ended;

static void fail(const char* what) {
  perror(what);
  exit(1);
}

static uint64_t now_ns(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

static void note_result(uint64_t sequence) {
  started = 1;
  const uint64_t index = sequence - first;
  if (sequence < first || index >= frames) return;
  if (latency_ns[index] != 0) {
    ++twice;
    return;
  }
  latency_ns[index] = now_ns() - sent_ns[index];
  ++received;
}

/* --- Shared memory --------------------------------------------------------------------------- */

static PillarfieldRing* open_ring(const char* name, size_t bytes) {
  char path[256];
  snprintf(path, sizeof path, "/%s", name);
  if (bytes != 0) {
    shm_unlink(path);
    const int segment = shm_open(path, O_RDWR | O_CREAT | O_EXCL, 0600);
    if (segment < 0 || flock(segment, LOCK_EX) != 0 || ftruncate(segment, (off_t)bytes) != 0) {
      fail(path);
    }
    return mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, segment, 0);
  }
  const int segment = shm_open(path, O_RDONLY, 0);
  struct stat status;
  if (segment < 0) return NULL;
  if (fstat(segment, &status) != 0 || status.st_size < (off_t)sizeof(PillarfieldRing)) {
    close(segment);
    return NULL;
  }
  PillarfieldRing* ring = mmap(NULL, (size_t)status.st_size, PROT_READ, MAP_SHARED, segment, 0);
  close(segment);
  if (ring == MAP_FAILED) fail(path);
  return ring;
}

static PillarfieldRing* make_frame_ring(const char* name) {
  const uint64_t slot =
      (sizeof(PillarfieldFrameSlot) + (uint64_t)options.rows * options.cols + 63) / 64 * 64;
  PillarfieldRing wanted = {PILLARFIELD_RING_MAGIC,
                            PILLARFIELD_RING_FRAMES,
                            options.rows,
                            options.cols,
                            PILLARFIELD_U8,
                            16,
                            slot,
                            now_ns(),
                            0,
                            0,
                            0,
                            0};
  PillarfieldRing* ring = open_ring(name, sizeof wanted + wanted.slots * slot);
  memcpy(&ring->kind, &wanted.kind, sizeof wanted - sizeof wanted.magic);
  __atomic_store_n(&ring->magic, wanted.magic, __ATOMIC_RELEASE);
  return ring;
}

static void publish(PillarfieldRing* ring, const PillarfieldPacket* packet, const void* readings) {
  const uint64_t number = ring->published;
  PillarfieldFrameSlot* slot =
      (PillarfieldFrameSlot*)((char*)(ring + 1) + number % ring->slots * ring->slot_bytes);
  __atomic_store_n(&slot->lock, 2 * number + 1, __ATOMIC_RELAXED);
  __atomic_thread_fence(__ATOMIC_RELEASE);
  slot->packet = *packet;
  memcpy(slot + 1, readings, packet->bytes);
  __atomic_store_n(&slot->lock, 2 * number + 2, __ATOMIC_RELEASE);
  __atomic_store_n(&ring->published, number + 1, __ATOMIC_RELEASE);
  __atomic_store_n(&ring->signal, (uint32_t)(number + 1), __ATOMIC_RELEASE);
  syscall(SYS_futex, &ring->signal, FUTEX_WAKE, INT_MAX, NULL, NULL, 0);
}

static void read_ring(const char* name) {
  PillarfieldRing* ring = NULL;
  while (!ended && (ring = open_ring(name, 0)) == NULL) usleep(1000);
  if (ring == NULL) return;
  for (uint64_t next = __atomic_load_n(&ring->published, __ATOMIC_ACQUIRE); !ended;) {
    const uint32_t signal = __atomic_load_n(&ring->signal, __ATOMIC_ACQUIRE);
    const uint64_t published = __atomic_load_n(&ring->published, __ATOMIC_ACQUIRE);
    const struct timespec wait = {0, 10000000};
    if (published == next) {
      syscall(SYS_futex, &ring->signal, FUTEX_WAIT, signal, &wait, NULL, 0);
      continue;
    }
    for (; next < published; ++next) {
      const PillarfieldResultSlot* slot =
          (const PillarfieldResultSlot*)((const char*)(ring + 1) +
                                         next % ring->slots * ring->slot_bytes);
      const uint64_t sequence = slot->sequence;
      __atomic_thread_fence(__ATOMIC_ACQUIRE);
      if (__atomic_load_n(&slot->lock, __ATOMIC_RELAXED) == 2 * next + 2) note_result(sequence);
    }
  }
}

/* --- UDP ------------------------------------------------------------------------------------- */

static struct sockaddr_in address_of(const char* text) {
  char host[64] = "";
  const char* colon = strrchr(text, ':');
  struct sockaddr_in address = {.sin_family = AF_INET};
  if (colon == NULL || (size_t)(colon - text) >= sizeof host) fail(text);
  memcpy(host, text, (size_t)(colon - text));
  address.sin_port = htons((uint16_t)atoi(colon + 1));
  if (inet_pton(AF_INET, host, &address.sin_addr) != 1) fail(text);
  return address;
}

static void read_datagrams(const char* text) {
  static char datagram[65536];
  const struct sockaddr_in address = address_of(text);
  const struct timeval patience = {0, 10000};
  const int size = 1 << 22;
  const int in = socket(AF_INET, SOCK_DGRAM, 0);
  setsockopt(in, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  setsockopt(in, SOL_SOCKET, SO_RCVBUF, &size, sizeof size);
  if (bind(in, (const struct sockaddr*)&address, sizeof address) != 0) fail(text);
  while (!ended) {
    const ssize_t bytes = recv(in, datagram, sizeof datagram - 1, 0);
    if (bytes <= 0) continue;
    datagram[bytes] = 0;
    const char* key = strstr(datagram, "\"sequence\":");
    if (key != NULL) note_result(strtoull(key + 11, NULL, 10));
  }
}

/* --- The measurement ------------------------------------------------------------------------- */

static int is_ring(const char* text) { return strncmp(text, "shm:", 4) == 0; }

static void* receive(void* unused) {
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  if (is_ring(options.out))
    read_ring(options.out + 4);
  else
    read_datagrams(options.out + 4);
  return unused;
}

/* A pressed spot that crosses the skin. */
static void scan(uint8_t* readings, uint64_t frame) {
  const int middle_row = (int)(options.rows / 2), middle_col = (int)(frame % options.cols);
  memset(readings, 0, (size_t)options.rows * options.cols);
  for (int row = middle_row - 12; row <= middle_row + 12; ++row) {
    for (int col = middle_col - 12; col <= middle_col + 12; ++col) {
      const int square =
          (row - middle_row) * (row - middle_row) + (col - middle_col) * (col - middle_col);
      if (row < 0 || col < 0 || row >= (int)options.rows || col >= (int)options.cols) continue;
      if (square < 144)
        readings[(size_t)row * options.cols + (size_t)col] = (uint8_t)(200 - square);
    }
  }
}

static void send_frames(void) {
  const size_t bytes = (size_t)options.rows * options.cols;
  const double period = 1e9 / options.rate;
  PillarfieldRing* ring = NULL;
  struct sockaddr_in address = {0};
  int out = -1;
  uint8_t* datagram = malloc(sizeof(PillarfieldPacket) + bytes);
  if (datagram == NULL) fail("memory");
  if (is_ring(options.in))
    ring = make_frame_ring(options.in + 4);
  else {
    address = address_of(options.in + 4);
    out = socket(AF_INET, SOCK_DGRAM, 0);
  }
  const uint64_t session = now_ns(), start = session;
  /* Frames are sent, but not measured, until results come. */
  for (uint64_t sequence = 0; first == UINT64_MAX || sequence < first + frames; ++sequence) {
    if (first == UINT64_MAX && started) first = sequence + (uint64_t)(options.rate / 10);
    const uint64_t due = start + (uint64_t)((double)sequence * period);
    const struct timespec until = {(time_t)(due / 1000000000u), (long)(due % 1000000000u)};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, NULL);
    scan(datagram + sizeof(PillarfieldPacket), sequence);
    PillarfieldPacket packet = {PILLARFIELD_PACKET_MAGIC,
                                PILLARFIELD_FRAME,
                                PILLARFIELD_U8,
                                options.rows,
                                options.cols,
                                session,
                                sequence,
                                now_ns(),
                                0,
                                1,
                                0,
                                0,
                                0,
                                (uint32_t)bytes};
    if (sequence >= first) sent_ns[sequence - first] = packet.time_ns;
    if (ring != NULL) {
      publish(ring, &packet, datagram + sizeof packet);
    } else {
      memcpy(datagram, &packet, sizeof packet);
      sendto(out, datagram, sizeof packet + bytes, 0, (struct sockaddr*)&address, sizeof address);
    }
    if (!started && (double)(now_ns() - start) > 6e10) {
      fprintf(stderr, "no result came within a minute\n");
      exit(1);
    }
  }
  if (ring != NULL) {
    char path[256];
    usleep(500000);
    __atomic_store_n(&ring->closed, 1, __ATOMIC_RELEASE);
    syscall(SYS_futex, &ring->signal, FUTEX_WAKE, INT_MAX, NULL, NULL, 0);
    snprintf(path, sizeof path, "/%s", options.in + 4);
    shm_unlink(path);
  } else {
    const PillarfieldPacket end = {PILLARFIELD_PACKET_MAGIC,
                                   PILLARFIELD_END,
                                   PILLARFIELD_U8,
                                   options.rows,
                                   options.cols,
                                   session,
                                   first + frames,
                                   now_ns(),
                                   0,
                                   1,
                                   0,
                                   0,
                                   0,
                                   0};
    usleep(500000);
    sendto(out, &end, sizeof end, 0, (struct sockaddr*)&address, sizeof address);
  }
  free(datagram);
}

static int compare(const void* a, const void* b) {
  const uint64_t x = *(const uint64_t*)a, y = *(const uint64_t*)b;
  return x < y ? -1 : x > y;
}

/* Latency in ms that this part of all frames did not exceed; a frame that did not come never did.
 */
static void print_quantile(const char* name, double part) {
  const uint64_t rank = (uint64_t)(part * (double)(frames - 1));
  const uint64_t latency = latency_ns[rank];
  if (latency == UINT64_MAX)
    printf(", \"%s\": null", name);
  else
    printf(", \"%s\": %.4f", name, 1e-6 * (double)latency);
}

static void parse(int count, char** words) {
  for (int i = 3; i + 1 < count; i += 2) {
    const double value = atof(words[i + 1]);
    if (strcmp(words[i], "--rate") == 0) options.rate = value;
    if (strcmp(words[i], "--seconds") == 0) options.seconds = value;
    if (strcmp(words[i], "--rows") == 0) options.rows = (uint32_t)value;
    if (strcmp(words[i], "--cols") == 0) options.cols = (uint32_t)value;
  }
  options.in = words[1];
  options.out = words[2];
}

int main(int count, char** words) {
  pthread_t receiver;
  if (count < 3 || count % 2 == 0) {
    fprintf(stderr,
            "Usage: live_latency IN OUT [--rate HZ] [--seconds S] [--rows N] [--cols N]; "
            "IN and OUT are shm:NAME or udp:ADDRESS:PORT\n");
    return 2;
  }
  parse(count, words);
  frames = (uint64_t)(options.rate * options.seconds);
  sent_ns = calloc(frames, sizeof *sent_ns);
  latency_ns = calloc(frames, sizeof *latency_ns);
  if (frames == 0 || sent_ns == NULL || latency_ns == NULL) fail("frames");
  if (pthread_create(&receiver, NULL, receive, NULL) != 0) fail("thread");
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  send_frames();
  ended = 1;
  pthread_join(receiver, NULL);
  for (uint64_t i = 0; i < frames; ++i) {
    if (latency_ns[i] == 0) latency_ns[i] = UINT64_MAX;
  }
  qsort(latency_ns, frames, sizeof *latency_ns, compare);
  printf("{\"sent\": %llu, \"received\": %llu, \"twice\": %llu", (unsigned long long)frames,
         (unsigned long long)received, (unsigned long long)twice);
  print_quantile("p50_ms", 0.5);
  print_quantile("p90_ms", 0.9);
  print_quantile("p99_ms", 0.99);
  print_quantile("p99_9_ms", 0.999);
  print_quantile("worst_ms", 1);
  printf("}\n");
  return 0;
}
