"""Dask distributed: the bits of a serial solve with 1, 2 and 4 workers, also when workers are killed."""

import logging
import os
import pathlib
import random
import shutil
import signal
import sys
import threading
import time
import unittest
from unittest import mock

import pillarfield as pf

sys.path.insert(0, f"{os.environ['PILLARFIELD_SOURCE']}/tests/cli")

from command import datasets  # noqa: E402

WORK = pathlib.Path(os.environ["PILLARFIELD_WORK"])
PLAN = {"contacts": True, "estimator": "contact", "baseline_time_s": 0.5, "noise_counts": 0.5,
        "checkpoint_every": 20, "warm_up": 10}


def make_recording(path):
    scene = {"skin": {"pillars": [60, 60]}, "sensor": {"adc_bits": 8, "noise_counts": 0.5},
             "time": {"frames": 400},
             "contact": [{"shape": "sphere", "motion": "slide", "contact_radius_mm": 10,
                          "position_mm": [0, 0], "load_n": 30, "friction": 0.8}]}
    simulation = pf.simulate(scene)
    pf.save_recording(path, simulation, overwrite=True)


class Distributed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)
        WORK.mkdir(parents=True)
        cls.recording = WORK / "rec.h5"
        make_recording(cls.recording)
        pf.distributed.solve_part(cls.recording, WORK / "serial.h5", 1, 1, **PLAN)
        pf.distributed.join(WORK / "serial.h5", overwrite=True)
        cls.serial = datasets(WORK / "serial.h5")

    def assert_serial(self, output):
        found = datasets(output)
        self.assertEqual(sorted(found), sorted(self.serial))
        for name, values in self.serial.items():
            self.assertEqual(found[name].tobytes(), values.tobytes(), name)

    def with_workers(self, workers, action):
        try:
            from distributed import Client, LocalCluster
        except ImportError:
            self.skipTest("python3-distributed is not installed")
        with LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None,
                          silence_logs=logging.CRITICAL) as cluster, Client(cluster) as client:
            return action(client)

    def test_workers(self):
        for workers in (1, 2, 4):
            output = WORK / f"workers{workers}.h5"
            file = self.with_workers(
                workers, lambda client: pf.distributed.solve(client, self.recording, output, **PLAN))
            self.assertEqual(len(file), 400)
            self.assert_serial(output)
            # One a checkpoint, whatever the number of workers.
            self.assertEqual(len(list((WORK / f"workers{workers}.h5.parts").iterdir())), 400 // 20)

    def test_killed_workers(self):
        rng = random.Random(21)

        def solve(client):
            kills = 0
            stop = threading.Event()

            def kill():
                nonlocal kills
                while not stop.wait(rng.uniform(0.1, 1.0)) and kills < 10:
                    processes = list(client.run(os.getpid).values())
                    if processes:
                        os.kill(rng.choice(processes), signal.SIGKILL)
                        kills += 1

            killer = threading.Thread(target=kill)
            killer.start()
            try:
                while kills < 10:
                    shutil.rmtree(WORK / "killed.h5.parts", ignore_errors=True)
                    pf.distributed.solve(client, self.recording, WORK / "killed.h5", parts=10,
                                         attempts=30, **PLAN)
                    self.assert_serial(WORK / "killed.h5")
            finally:
                stop.set()
                killer.join()
            return kills

        self.assertEqual(self.with_workers(2, solve), 10)

    def test_ctrl_c_ends_solve_and_join(self):
        """Workers finish the parts that they have begun, and the same call continues."""
        interrupted = WORK / "interrupted.h5"

        def solve(client):
            parts = WORK / "interrupted.h5.parts"
            def interrupt():
                while not (parts.is_dir() and list(parts.glob("?????.h5"))):
                    time.sleep(0.02)
                os.kill(os.getpid(), signal.SIGINT)
            thread = threading.Thread(target=interrupt)
            thread.start()
            with self.assertRaises(KeyboardInterrupt):
                pf.distributed.solve(client, self.recording, interrupted, parts=20, **PLAN)
            thread.join()
            self.assertFalse(interrupted.exists())
            while client.run(lambda dask_worker: len(dask_worker.state.executing))[
                    next(iter(client.scheduler_info()["workers"]))]:
                time.sleep(0.05)
            self.assertLess(len(list(parts.glob("?????.h5"))), 20)
            pf.distributed.solve(client, self.recording, interrupted, parts=20, **PLAN)
            self.assert_serial(interrupted)
        self.with_workers(1, solve)
        before = signal.signal(signal.SIGALRM, signal.default_int_handler)
        signal.setitimer(signal.ITIMER_REAL, 0.1)
        with self.assertRaises(KeyboardInterrupt):
            while True:
                pf.distributed.join(interrupted, overwrite=True)
        self.assertEqual(len(pf.open(interrupted)), 400)
        self.assertFalse((WORK / "interrupted.h5.part").exists())
        signal.signal(signal.SIGALRM, before)

    def test_errors(self):
        def solve(client):
            for plan, words in (({"baseline_time_s": 1}, "--checkpoint-every"),
                                ({"calibration": pf.open(self.recording).calibration}, "its path"),
                                ({"parts": 1000}, "400 frames")):
                with self.assertRaises(pf.Error) as caught:
                    pf.distributed.solve(client, self.recording, WORK / "wrong.h5", **plan)
                self.assertIn(words, str(caught.exception))
            time.sleep(0.1)
        self.with_workers(1, solve)
        with mock.patch.dict("sys.modules", {"distributed": None}):
            with self.assertRaisesRegex(pf.Error, "python3-distributed"):
                pf.distributed.solve(None, self.recording, WORK / "wrong.h5")


if __name__ == "__main__":
    unittest.main()
