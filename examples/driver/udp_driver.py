#!/usr/bin/env python3
"""A driver in Python: sends the frames of a pressed spot that moves by UDP, 100 a second.

    ./udp_driver.py 9870 [SECONDS] &
    pillarfield stream udp:127.0.0.1:9870
"""
import math, random, socket, struct, sys, time

rows, cols, session = 64, 64, random.getrandbits(64)
out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
for number in range(int(100 * float(sys.argv[2] if len(sys.argv) > 2 else 10))):
    place = 32 + 20 * math.sin(0.02 * number)
    readings = bytes(int(200 * math.exp(-((r - 32) ** 2 + (c - place) ** 2) / 50)) for r in range(rows) for c in range(cols))
    header = struct.pack("<4sHHIIQQQ6I", b"PFR1", 0, 1, rows, cols, session, number, time.monotonic_ns(), 0, 1, 0, 0, 0, len(readings))
    out.sendto(header + readings, ("127.0.0.1", int(sys.argv[1])))
    time.sleep(0.01)
