"""Memory and file descriptors stay as they are; FRAMES in the environment is the number of frames."""

import gc
import os

import numpy as np

import pillarfield as pf
import skins

FRAMES = int(os.environ.get("FRAMES", 20_000))
MOST_GROWTH = 4 << 20  # bytes; a leak of 200 bytes a frame shows


def resident():
    gc.collect()
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE")


def descriptors():
    return len(os.listdir("/proc/self/fd"))


def stream(frames, plan, count):
    """Streams frames in every way that results are lent, copied and dropped."""
    held = []
    with pf.Processor(plan, frames_in_flight=3, contacts=True) as processor:
        for index, forces in enumerate(processor.stream(
                (frames[i % len(frames)] for i in range(count)), ahead=1)):
            held.append(forces.contacts if index % 3 else forces)
            del held[:-5]


def solve(simulation, rounds):
    frames = np.tile(simulation.frames, (8, 1, 1))  # A plane of the result has 230 kB.
    for _ in range(rounds):
        pf.solve(frames, contacts=True, outputs=["angles"], layout="pillars")
        pf.solve(iter(simulation.frames[:3]))
        try:
            pf.solve(simulation.frames, estimator="none")
        except pf.Error:
            pass
        pf.solve(simulation.frames[0]).picture()


def main():
    simulation = pf.simulate(skins.scene())
    plan = skins.plan_of(simulation)
    stream(simulation.frames, plan, FRAMES // 4)
    solve(simulation, 30)
    before, files = resident(), descriptors()
    for _ in range(4):
        stream(simulation.frames, plan, FRAMES // 4)
    after_stream = resident()
    solve(simulation, FRAMES // 200)
    growth, solve_growth = after_stream - before, resident() - after_stream
    print(f"{FRAMES} frames: resident memory grew by {growth} and {solve_growth} bytes")
    assert growth < MOST_GROWTH and solve_growth < MOST_GROWTH
    assert descriptors() == files, (files, descriptors())


if __name__ == "__main__":
    main()
