"""A FlexiTac board on a pseudo-terminal, whose name is printed.

    flexitac_board.py ROWS COLS RATE FRAMES LOSES SENT.npy

Sends idle frames until a line comes on standard input, then FRAMES random ones, which are saved, prints how many
frames it has sent in all, and goes on with idle ones. Every LOSES-th random frame loses a byte; 0: none does."""

import os
import select
import sys
import time
import tty

import numpy

MARKS = b"\xaa\x55"
ROWS, COLS, RATE, FRAMES, LOSES = map(int, sys.argv[1:6])

random = numpy.random.default_rng(5)
frames = random.integers(0, 256, (FRAMES, ROWS, COLS), dtype=numpy.uint8)
for frame in frames[::4]:  # readings that look like marks
    frame.flat[random.integers(0, frame.size - 1) + numpy.arange(2)] = tuple(MARKS)
numpy.save(sys.argv[6], frames)

line, board = os.openpty()
tty.setraw(board)
print(os.ttyname(board), flush=True)
due = time.monotonic()
sent = 0


def send(readings):
    global due, sent
    sent += 1
    due += 1 / RATE
    time.sleep(max(0, due - time.monotonic()))
    readings = MARKS + readings
    while readings:
        readings = readings[os.write(line, readings):]


def idle_until_told():
    while not select.select([sys.stdin], [], [], 0)[0]:
        send(bytes(ROWS * COLS))
    sys.stdin.readline()


idle_until_told()
for number, frame in enumerate(frames, 1):
    readings = bytearray(frame.tobytes())
    if LOSES and number % LOSES == 0:
        del readings[random.integers(0, len(readings))]
    send(bytes(readings))
print(sent, flush=True)
idle_until_told()
