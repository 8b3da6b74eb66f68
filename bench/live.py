#!/usr/bin/python3
"""Measures `pillarfield stream` from outside: latency and losses of frames that come and go through
shared memory and UDP, with all sinks attached and a client at each, and what hostile clients of the
WebSocket server change.

    bench/live.py --seconds 60          latency with all sinks
    bench/live.py --hostile --rounds 5  with and without hostile clients, in turns
    bench/live.py --hostile --apart     the same, with the clients on a processor of their own
"""

import argparse
import json
import os
import pathlib
import socket
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests/streams"))
from websocket_client import Closed, FoxgloveClient  # noqa: E402

QUANTILES = ("p50_ms", "p90_ms", "p99_ms", "p99_9_ms", "worst_ms")


def free_port(kind=socket.SOCK_STREAM):
    with socket.socket(socket.AF_INET, kind) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def compiled(folder):
    program = folder / "live_latency"
    subprocess.run(["cc", "-O2", f"-I{ROOT / 'host/include'}", ROOT / "bench/live_latency.c", "-o",
                    program, "-lpthread"], check=True)
    return program


class Counter(threading.Thread):
    """Counts the messages of a client until it ends."""

    def __init__(self, connect):
        super().__init__(daemon=True)
        self.connect, self.count = connect, 0
        self.start()

    def run(self):
        try:
            for _ in self.connect():
                self.count += 1
        except (Closed, OSError):
            pass


def datagrams(port):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
        receiver.bind(("127.0.0.1", port))
        receiver.settimeout(3)
        while True:
            yield receiver.recv(65536)


def patient(action, seconds=30):
    end = time.monotonic() + seconds
    while True:
        try:
            return action()
        except OSError:
            if time.monotonic() > end:
                raise
            time.sleep(0.02)


def foxglove_messages(port):
    with patient(lambda: FoxgloveClient(port)) as client:
        client.subscribe("/skin/forces", "/skin/contacts/1", "/skin/health")
        while True:
            yield client.read_data()


def never_reads(port, stop):
    """Subscribes to everything and never reads."""
    with patient(lambda: FoxgloveClient(port)) as client:
        client.subscribe(*client.channels)
        stop.wait()


def sends_garbage(port, stop):
    while not stop.is_set():
        try:
            with socket.create_connection(("127.0.0.1", port), timeout=5) as client:
                client.sendall(os.urandom(4096))
                client.recv(100)
        except OSError:
            pass
        time.sleep(0.02)


def opens_many(port, stop):
    while not stop.is_set():
        clients = []
        try:
            for _ in range(1000):
                clients.append(socket.create_connection(("127.0.0.1", port), timeout=5))
        except OSError:
            pass
        stop.wait(2)
        for client in clients:
            client.close()


def dies_mid_frame(port, stop):
    while not stop.is_set():
        try:
            with FoxgloveClient(port) as client:
                client.subscribe(*client.channels)
                client.read_data()
                client.socket.sendall(b"\x82\xff")
        except (OSError, Closed, AssertionError):
            pass
        time.sleep(0.05)


HOSTILE = (never_reads, sends_garbage, opens_many, dies_mid_frame)


def start(command, apart):
    """Starts a command; with `apart` on all processors but the last, which the clients have."""
    if apart:
        last = max(os.sched_getaffinity(0))  # the only one, since main()
        command = ["taskset", "-c", f"0-{last - 1}", *command]
    return subprocess.Popen(command, stdout=subprocess.PIPE, text=True)


def measure(program, latency, path, seconds, rate, apart, hostile=False):
    """One run over `path` ("shm" or "udp") with all sinks."""
    name = f"pillarfield-live-{os.getpid()}"
    ports = [free_port(socket.SOCK_DGRAM) for _ in range(3)]
    foxglove = free_port()
    ends = {"shm": (f"shm:{name}-in", f"shm:{name}-out"),
            "udp": (f"udp:127.0.0.1:{ports[0]}", f"udp:127.0.0.1:{ports[1]}")}
    frames_in, out = ends[path]
    other = (f"shm:{name}-out" if path == "udp" else f"udp:127.0.0.1:{ports[2]}")
    with tempfile.TemporaryDirectory() as folder:
        stream = start(
            [program, "stream", frames_in, "--to", out, "--to", other, "--to",
             f"foxglove:{foxglove}", "--to", f"{folder}/live.mcap", "--record",
             f"{folder}/raw.h5", "--threshold", "2", "--end-when-idle", "2", "--json"], apart)
        counters = [Counter(lambda: foxglove_messages(foxglove))]
        if path == "shm":
            counters.append(Counter(lambda: datagrams(ports[2])))
        stop = threading.Event()
        if hostile:
            for action in HOSTILE:
                threading.Thread(target=action, args=(foxglove, stop), daemon=True).start()
        client = start([latency, frames_in, out, "--seconds", str(seconds), "--rate", str(rate)],
                       apart)
        measured = client.communicate()[0]
        stop.set()
        if client.returncode != 0:
            sys.exit(f"{latency} failed")
        lines = stream.communicate(timeout=60)[0].splitlines()
        summary = json.loads(lines[-1])["summary"]
    result = json.loads(measured)
    result["messages"] = [counter.count for counter in counters]
    result["stream"] = summary
    return result


def print_row(label, result):
    stream = result["stream"]
    dropped = {sink["name"].split("/")[-1]: sink["dropped"] for sink in stream["sinks"]}
    latencies = "  ".join(f"{name[:-3]} {result[name]}" for name in QUANTILES)
    print(f"{label}: {latencies} ms; {result['received']} of {result['sent']} frames; solved "
          f"{stream['solved']}, lost {stream['lost']}, late by the program {stream['overrun']}; "
          f"dropped by sinks {dropped}; messages read {result['messages']}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=ROOT / "build/release/bin/pillarfield")
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--rate", type=float, default=1000)
    parser.add_argument("--hostile", action="store_true")
    parser.add_argument("--apart", action="store_true",
                        help="clients on the last processor, all else on the others")
    parser.add_argument("--rounds", type=int, default=3)
    options = parser.parse_args()
    if options.apart:
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    with tempfile.TemporaryDirectory() as folder:
        latency = compiled(pathlib.Path(folder))
        run = [options.program, latency]
        if not options.hostile:
            for path in ("shm", "udp"):
                print_row(path, measure(*run, path, options.seconds, options.rate, options.apart))
            return
        pairs = []
        for _ in range(options.rounds):
            pair = [measure(*run, "shm", options.seconds, options.rate, options.apart, hostile)
                    for hostile in (False, True)]
            for label, result in zip(("alone  ", "hostile"), pair):
                print_row(label, result)
            pairs.append(pair)
        for name in QUANTILES[:4]:
            ratios = sorted(hostile[name] / alone[name] for alone, hostile in pairs)
            print(f"{name}: hostile over alone, median {ratios[len(ratios) // 2]:.3f} "
                  f"({ratios[0]:.3f} to {ratios[-1]:.3f})")


if __name__ == "__main__":
    main()
