"""Thousands of calls with random arguments end in Python exceptions or results, never in a signal.

CALLS in the environment replaces their number; a failure prints the seed, which SEED repeats.
"""

import os
import pathlib
import random
import subprocess
import sys
import threading
import warnings

import numpy as np

import pillarfield as pf

WORK = pathlib.Path(os.environ["PILLARFIELD_WORK"])
CALLS = int(os.environ.get("CALLS", 6_000))
SEED = int(os.environ.get("SEED", random.randrange(1 << 30)))
SHARE = 2  # child processes, one after the other

SHAPES = [(), (0,), (3,), (2, 2), (8, 12), (3, 8, 12), (0, 8, 12), (3, 0, 12), (1, 1, 1), (2, 2, 2, 2),
          (5, 7), (1, 2, 70_000)]
KINDS = ["u1", "u2", "f4", "f8", "i8", "i1", ">u2", ">f4", "c8", "?", "O", "S3", "U2", "M8[s]", "f2"]
NUMBERS = [0, 1, -1, 2, 7, 0.5, -0.5, 1e-320, 1e308, -1e308, float("nan"), float("inf"), 2**31, 2**32,
           2**63, 2**64, -(2**63), 10**40, True]
WORDS = ["", "direct", "paper", "contact", "angles", "uncertainty", "normal", "phi", "uint8", "float32",
         "\0", "ü\udc80", "a" * 10_000, "/", "-", "udp:", "shm:", "/dev/null/x", "%s%n", "linear"]


class Angry:
    """Raises in whatever is asked of it."""

    def __getattr__(self, name):
        raise OverflowError(name)

    def __iter__(self):
        raise FloatingPointError("iter")

    def __fspath__(self):
        raise LookupError("path")


class Choices:
    def __init__(self, seed):
        self.random = random.Random(seed)
        self.made = []  # results, used as arguments again

    def array(self):
        shape, kind = self.random.choice(SHAPES), self.random.choice(KINDS)
        seed = self.random.randrange(1 << 30)
        values = np.random.default_rng(seed).integers(0, 200, shape)
        array = values.astype(kind)
        if array.dtype.kind == "f" and array.size and self.random.random() < 0.5:
            array.flat[0] = self.random.choice([np.nan, np.inf, -np.inf, -5])
        turn = self.random.randrange(6)
        if turn == 0 and array.ndim:
            return array[..., ::-1]
        if turn == 1:
            return array.T
        if turn == 2:
            array.flags.writeable = False
        if turn == 3 and array.ndim:
            return np.broadcast_to(array, (2, *array.shape))
        return array

    def frames(self):
        return [self.array() for _ in range(self.random.randrange(4))]

    def iterator(self):
        good = [np.zeros((8, 12), np.uint8)] * self.random.randrange(3)
        yield from good
        yield self.value(1)
        raise ArithmeticError("the user's")

    def value(self, depth=0):
        kind = self.random.randrange(16)
        if kind < 4 and self.made:
            return self.random.choice(self.made)
        if kind < 7:
            return self.array()
        if kind < 9:
            return self.random.choice(NUMBERS)
        if kind < 11:
            return self.random.choice(WORDS)
        if kind == 11 and depth < 3:
            return [self.value(depth + 1) for _ in range(self.random.randrange(4))]
        if kind == 12 and depth < 3:
            return {self.random.choice(WORDS + ["skin", "pillars"]): self.value(depth + 1)}
        if kind == 13:
            return self.iterator()
        if kind == 14:
            return self.random.choice([Angry(), object(), print, slice(None, None, 0), range(5), b"x"])
        return None


def functions():
    """All that can be called: what the package exports and what its compiled half has."""
    found = [getattr(pf, name) for name in pf.__all__]
    found += [getattr(pf.calibrate, name) for name in pf.calibrate.__all__]
    found += [value for name, value in vars(pf._core).items() if not name.startswith("__")]
    # These wait for a sensor or read standard input.
    waits = {pf.live, pf.LiveSource, pf._core.LiveFrames}
    return [value for value in found if callable(value) and value not in waits]


KEYWORDS = ["skin", "calibration", "times", "rate_hz", "contacts", "estimator", "outputs", "status",
            "threshold_counts", "noise_counts", "friction_prior", "baseline_time_s", "scene", "tare",
            "frames_in_flight", "lent", "surface", "power_law", "frames", "seed", "model"]


def templates():
    """Calls that succeed, of which some arguments are then replaced."""
    frame = np.full((8, 12), 60, np.uint8)
    frames, skin, zero = np.stack([frame] * 3), pf.Skin(8, 12), np.zeros((8, 12))
    plan, calibration = pf.Plan(skin), pf.Calibration(8, 12, tare=zero)
    source = pf._core.FrameSource.of_array(frames, np.arange(3.0), skin, calibration)
    forces, core = pf.solve(frames, contacts=True), pf._core
    planes = forces._batch()
    processor = pf.Processor(plan, contacts=True, frames_in_flight=3)
    scene = {"skin": {"pillars": [4, 6]}, "time": {"frames": 2}}
    made = pf.scene(scene)
    return [
        (pf.solve, (frames,), {"skin": skin, "times": [0, 1, 2], "outputs": ["angles"], "rate_hz": 9}),
        (pf.solve, (frames,), {"calibration": calibration, "estimator": "contact", "contacts": True}),
        (pf.solve, ([frame, frame],), {"noise_counts": 1.0, "friction_prior": (1.0, 0.3)}),
        (pf.solve, (made,), {}), (pf.simulate, (scene,), {"frames": 2, "seed": 3}),
        (pf.Plan, (skin,), {"sensel_type": "uint16", "baseline_time_s": 3.0, "baseline_interval": 2}),
        (pf.Skin, (8, 12), {"counts_per_newton": 100.0, "full_scale_counts": 200.0, "power_law": (1, 2)}),
        (pf.Calibration, (8, 12), {"tare": zero, "gain": zero + 1, "mask": zero, "noise": zero}),
        (pf.Surface.height_map, (zero,), {}), (pf.Surface.cylinder, (20.0,), {"axis_deg": 5.0}),
        (pf.ForceField, (zero, zero, zero), {"status": zero, "times": 0.0, "skin": skin}),
        (pf.Processor, (plan,), {"frames_in_flight": 2, "lent": 1, "contacts": True}),
        (processor.submit, (frame, 0.0), {}), (processor.receive_planes, (), {}),
        (processor.submit_readings, (frame, 0.0, [(0, 1, 2, 3)]), {}), (processor.try_receive, (), {}),
        (processor.set_tare, (zero,), {}), (lambda v: list(processor.stream(v, 1)), (frames,), {}),
        (pf.Contacts(plan).over, (forces,), {}), (core.Tracker(plan).update_planes, (planes, [0, 1, 2]), {}),
        (pf.compare, (forces, forces), {}), (core.compare, (planes, planes), {}),
        (core.paint, (forces[0]._batch(), "normal", (0.0, 1.0), True, skin), {}),
        (forces[0].picture, ("shear",), {"limits": (0.0, 1.0), "theme": "light"}),
        (forces.where, (pf.Status.AMBIGUOUS,), {}), (forces.__getitem__, (slice(0, 2),), {}),
        (source.read, (0, 1, 3), {}), (source.read_truth, (0, 1, 1), {}), (source.times, (2,), {}),
        (core.FrameSource.of_array, (frames, [0.0, 1.0, 2.0], skin, calibration), {}),
        (core.solve_source, (source, plan, True, ""), {}),
        (core.solve_iterator, (iter([(frame, 0.0)] * 3), plan, False, ""), {}),
        (core.save_forces, ("hostile.csv", planes, [0, 1, 2], skin, True), {}),
        (pf.save_recording, ("hostile.h5", frames), {"skin": skin, "overwrite": True}),
        (pf.open, ("hostile.h5",), {}), (core.Simulator(made).render, (0, 2), {}),
        (pf.calibrate.tare, (np.repeat(frames, 5, 0), calibration), {"threshold_factor": 4.0}),
        (pf.calibrate.equilibrate, ([(frames, 10.0), (frames, 20.0)], calibration), {"model": "linear"}),
        (pf.calibrate.load, ([(frames, 5.0)], calibration), {"power": True}),
        (pf.calibrate.shear, ([(frames, (1.0, 0.0))], calibration), {"normals_n": [3.0]}),
        (pf.calibrate.faults, ([frames], calibration), {}), (pf.calibrate.leak, ([frames], None), {}),
        (pf.calibrate.memory, ([(frames, [1, 2, 3])], calibration), {}),
        (pf.calibrate.bending, ([(frames, (50.0, 0.0))], calibration), {}),
        (pf.calibrate.arm, ([frames], calibration), {}), (pf.calibrate.wires, ([frames], None), {})]


def bent(choices, good):
    """A good call with some arguments replaced."""
    target, arguments, keywords = good

    def other(value):
        if isinstance(value, (list, tuple)) and value and choices.random.random() < 0.3:
            return type(value)(other(part) for part in value)
        return choices.value() if choices.random.random() < 0.25 else value

    return target(*map(other, arguments), **{name: other(value) for name, value in keywords.items()})


def call(choices, known):
    if choices.random.random() < 0.6:
        return bent(choices, choices.random.choice(choices.good))
    if choices.made and choices.random.random() < 0.5:
        target = choices.random.choice(choices.made)
        names = [name for name in dir(type(target)) if name not in ("__class__", "receive")
                 and not name.startswith(("__init_", "__re", "__del", "__set", "__new"))]
        target = getattr(target, choices.random.choice(names))
        if not callable(target):
            return target
    else:
        target = choices.random.choice(known)
    arguments = [choices.value() for _ in range(choices.random.randrange(6))]
    keywords = {choices.random.choice(KEYWORDS): choices.value()
                for _ in range(choices.random.randrange(3))}
    return target(*arguments, **keywords)


def good_objects():
    frame = np.full((8, 12), 60, np.uint8)
    skin = pf.Skin(8, 12)
    plan = pf.Plan(skin)
    forces = pf.solve(np.stack([frame] * 3), contacts=True)
    return [skin, plan, forces, forces[0], forces.contacts[0], pf.Processor(plan, contacts=True),
            pf.Contacts(plan), pf.Calibration(8, 12, tare=np.zeros((8, 12))), frame,
            pf._core.FrameSource.of_array(np.stack([frame] * 20), np.arange(20.0), skin, None),
            pf.scene({"skin": {"pillars": [4, 6]}}), forces._batch()]


def run(choices, calls, known, endings):
    for _ in range(calls):
        try:
            result = call(choices, known)
        except Exception as error:  # Whatever it is: it is an exception.
            assert "Internal error" not in str(error), error
            endings[type(error).__name__] = endings.get(type(error).__name__, 0) + 1
            continue
        endings["done"] = endings.get("done", 0) + 1
        if type(result).__module__.startswith("pillarfield") and not isinstance(result, type):
            choices.made.append(result)
            if len(choices.made) > 60:
                choices.made.pop(choices.random.randrange(12, 60))


def child(seed, calls):
    os.chdir(WORK)
    warnings.simplefilter("ignore")
    choices, known, endings = Choices(seed), functions(), {}
    choices.made, choices.good = good_objects(), templates()
    threads = []
    for number in range(3):  # Threads share the good objects.
        other = Choices(seed + 1 + number)
        other.made, other.good = list(choices.made), choices.good
        threads.append(threading.Thread(target=run, args=(other, calls // 6, known, endings)))
    for thread in threads:
        thread.start()
    run(choices, calls - 3 * (calls // 6), known, endings)
    for thread in threads:
        thread.join()
    fork = os.fork()  # A fork must end too, whatever it holds.
    if fork == 0:
        run(choices, 100, known, {})
        choices.made.clear()
        os._exit(0)
    status = os.waitpid(fork, 0)[1]
    assert status == 0, f"the fork ended with {status}"
    print(endings)
    assert endings["done"] > calls // 100 and endings.get("Error", 0) > calls // 100, endings


def main():
    if len(sys.argv) == 3:
        return child(int(sys.argv[1]), int(sys.argv[2]))
    WORK.mkdir(parents=True, exist_ok=True)
    for part in range(SHARE):
        seed = SEED + 10 * part
        done = subprocess.run([sys.executable, __file__, str(seed), str(CALLS // SHARE)], text=True,
                              stdin=subprocess.DEVNULL, capture_output=True, timeout=600)
        if done.returncode != 0:
            sys.exit(f"SEED={seed} ended with {done.returncode}\n{done.stdout}\n{done.stderr[-4000:]}")
        print(done.stdout, end="")


if __name__ == "__main__":
    main()
