"""pillarfield.solve: forces against an oracle and the command, from every kind of frames."""

import gc
import os
import pathlib
import pickle
import subprocess
import sys
import threading
import time
import types
import unittest
import warnings

import h5py
import numpy as np

import pillarfield as pf
import skins

WORK = pathlib.Path(os.environ["PILLARFIELD_WORK"])
RANDOM = np.random.default_rng(5)
PLANES = ("shear_x", "shear_y", "normal", "status")


def same(one, other, planes=PLANES):
    """Whether two fields have the same planes; without pillars there is no shear."""
    return one.has_pillars == other.has_pillars and all(
        np.array_equal(getattr(one, name), getattr(other, name))
        for name in planes if one.has_pillars or not name.startswith("shear"))


class Oracle(unittest.TestCase):
    def test_the_command_gives_the_same_bits(self):
        simulation = pf.simulate(skins.scene())
        recording, solved = WORK / "press.h5", WORK / "forces.h5"
        pf.save_recording(recording, simulation, overwrite=True)
        for estimator in ("direct", "contact"):
            subprocess.run([os.environ["PILLARFIELD"], "solve", recording, "-o", solved, "--overwrite",
                            "-q", "--estimator", estimator, "--noise", "0.5", "--outputs",
                            "angles,uncertainty"], check=True)
            forces = pf.solve(recording, estimator=estimator, noise_counts=0.5,
                              outputs=["angles", "uncertainty"])
            with h5py.File(solved) as file:
                for name in (*PLANES, "magnitude", "theta", "phi"):
                    np.testing.assert_array_equal(getattr(forces, name), file["force"][name], name)
                for name in ("normal", "phi_low", "magnitude_high"):
                    np.testing.assert_array_equal(getattr(forces.uncertainty, name),
                                                  file["uncertainty"][name], name)
            self.assertTrue(same(forces, pf.open(solved)[:]))

    def test_a_scene_gives_command_and_python_the_same_skin(self):
        scene, frames, solved = WORK / "pitch.toml", WORK / "pitch.npy", WORK / "pitch.h5"
        scene.write_text("[skin]\npillars = [8, 12]\nsensel_pitch_mm = 0.5\ncounts_per_newton = 200\n")
        np.save(frames, RANDOM.integers(100, 120, (16, 24)).astype(np.uint8))
        subprocess.run([os.environ["PILLARFIELD"], "solve", frames, "-o", solved, "--overwrite", "-q",
                        "--scene", scene], check=True)
        self.assertEqual(pf.Plan(pf.Skin(16, 24), scene=scene).skin.sensel_pitch_mm, 0.5)
        self.assertAlmostEqual(pf.open(solved).skin.sensel_pitch_mm, 0.5)


class Frames(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.simulation = pf.simulate(skins.scene())
        cls.frames = cls.simulation.frames
        cls.expected = pf.solve(cls.frames)

    def test_every_form_of_the_same_frames(self):
        frames = self.frames
        whole = frames.astype(np.uint16)
        unaligned = np.zeros(frames.size * 4 + 1, np.uint8)[1:].view(np.float32).reshape(frames.shape)
        unaligned[:] = frames
        np.save(WORK / "frames.npy", frames)
        np.testing.assert_array_equal(pf.solve(WORK / "frames.npy", rate_hz=50).times[1], 0.02)
        forms = {
            "list": frames.tolist(), "tuple": tuple(frames), "int64": frames.astype(np.int64),
            "float64": frames.astype(float), "float16": frames.astype(np.float16),
            "unaligned": unaligned, "columns first": np.asfortranarray(frames), "big endian": whole.astype(">u2"),
            "reversed twice": frames[::-1][::-1], "sliced": np.repeat(frames, 2, 2)[:, :, ::2],
            "mapped": np.load(WORK / "frames.npy", mmap_mode="r"), "iterator": iter(frames),
            "generator": (frame.astype(float) for frame in frames)}
        for name, form in forms.items():
            with self.subTest(name):
                forces = pf.solve(form)
                self.assertEqual(forces.shape, (12, 40, 60))
                self.assertTrue(np.array_equal(forces.normal, self.expected.normal))

    def test_masked_readings_are_missing(self):
        hidden = np.zeros(self.frames.shape, bool)
        hidden[:, 8, 10] = True
        missing = np.where(hidden, np.nan, self.frames).astype(np.float32)
        expected = pf.solve(missing)
        self.assertTrue(same(pf.solve(np.ma.array(self.frames, mask=hidden)), expected))
        self.assertTrue(same(pf.solve(iter(np.ma.array(missing, mask=hidden))), expected))
        self.assertTrue(same(pf.solve(list(np.ma.array(self.frames, mask=hidden))), expected))
        self.assertFalse(np.array_equal(expected.status, self.expected.status))
        self.assertTrue(np.array_equal(pf.solve(np.ma.array(self.frames)).normal, self.expected.normal))

    def test_one_frame_has_planes_of_two_axes(self):
        one = pf.solve(self.frames[3])
        self.assertEqual((one.shape, one.times.shape), ((40, 60), ()))
        self.assertTrue(same(one, self.expected[3]))
        self.assertTrue(same(one, pf.solve(self.frames[3].tolist())))
        self.assertEqual(pf.solve(self.frames[:0]).shape, (0, 40, 60))

    def test_first_frames_give_the_tare(self):
        unloaded = RANDOM.normal(20, 1, (30, 40, 60)).round().astype(np.uint8)
        frames = np.concatenate([unloaded, self.frames // 2 + 20])
        step = pf.calibrate.tare(unloaded)
        expected = pf.solve(frames, calibration=step.calibration)
        np.save(WORK / "tare.npy", frames)
        self.assertAlmostEqual(float(np.abs(expected[0].normal).max()), 0, 2)
        for given in (frames, frames.tolist(), WORK / "tare.npy", pf.Recording(WORK / "tare.npy", rate_hz=9)):
            rate_hz = 50 if isinstance(given, pathlib.Path) else None
            self.assertTrue(same(pf.solve(given, tare_frames=30, rate_hz=rate_hz), expected))
        self.assertTrue(same(pf.solve(frames, calibration=step), expected))
        for wrong in ({"tare_frames": 9}, {"tare_frames": -5}, {"tare_frames": len(frames)},
                      {"calibration": frames[0]}):
            with self.assertRaises(pf.Error):
                pf.solve(frames, **wrong)
        with self.assertRaisesRegex(pf.Error, "an iterator's frames come once"):
            pf.solve(iter(frames), tare_frames=30)

    def test_a_touch_that_moves_is_no_tare(self):
        y, x = np.mgrid[:16, :16]
        rolled = RANDOM.normal(200, 1, (200, 16, 16))
        for t in range(40, 120):
            rolled[t] += 80 * np.exp(-0.3 * ((y - 8) ** 2 + (x - 2 - t / 10) ** 2))
        rolled = rolled.round().astype(np.uint16)
        np.save(WORK / "rolled.npy", rolled)
        for take in (lambda: pf.calibrate.tare(rolled), lambda: pf.solve(rolled, tare_frames=150),
                     lambda: pf.Recording(WORK / "rolled.npy", rate_hz=9, tare_frames=150)):
            with self.assertRaisesRegex(pf.Error, r"touched row [78], column \d+ in frames \d+ to \d+.*"
                                                  r"preloaded=True"):
                take()
        tare = pf.calibrate.tare(rolled[:40])
        with self.assertRaisesRegex(pf.Error, "changed since the tare before"):
            pf.calibrate.tare(rolled[:1] + RANDOM.normal(0, 1, (20, 16, 16)) + rolled[110] - rolled[0],
                              tare.calibration)
        self.assertGreater(pf.calibrate.tare(rolled, preloaded=True).facts["threshold_counts"], 40)

    def test_times_of_any_strides(self):
        self.assertEqual(pf.solve(self.frames, rate_hz=50).times[3], 0.06)
        table = np.column_stack([np.arange(12) / 50, np.full(12, 7.0)])
        for times in (table[:, 0], np.arange(24)[::2] / 100, list(np.arange(12) / 50), np.arange(12, dtype="f4") / 50):
            np.testing.assert_allclose(pf.solve(self.frames, times=times).times, np.arange(12) / 50, rtol=1e-6)
        for call in (lambda: pf.solve(WORK / "frames.npy", times=np.arange(12)),
                     lambda: pf.save_recording(WORK / "flat.h5", self.frames, times=np.zeros(12))):
            with self.assertRaises(pf.Error):
                call()

    def test_frames_of_a_sensor_name_what_did_not_arrive(self):
        frame = types.SimpleNamespace(readings=self.frames[0], time_s=3.0, missing=[(8, 2, 10, 2)])
        forces = pf.solve(iter([frame]), layout="pillars")
        self.assertEqual((forces.times[0], forces.status[0, 4, 5], forces.normal[0, 4, 5]),
                         (3, pf.Status.INCONSISTENT, 0))
        missing = pf.solve(iter([frame])).where(pf.Status.INCONSISTENT)[0]
        self.assertEqual([tuple(place) for place in np.argwhere(missing)],
                         [(8, 10), (8, 11), (9, 10), (9, 11)])

    def test_contacts_over_time(self):
        forces = pf.solve(self.simulation, contacts=True)
        again = pf.Contacts(skins.plan_of(self.simulation)).over(pf.solve(self.simulation))
        for frame, contacts, found in zip(forces, forces.contacts, again, strict=True):
            self.assertAlmostEqual(contacts.total.normal_n, float(frame.normal.sum()), 3)
            self.assertEqual((frame.contacts[0].track_id, len(found)), (1, len(contacts)))


class Memory(unittest.TestCase):
    def test_arrays_outlive_everything_and_are_writeable(self):
        frames = RANDOM.integers(0, 255, (20, 32, 48), np.uint8)
        forces = pf.solve(frames, outputs=["angles"], layout="pillars")
        kept, expected = forces[4:9].phi[1:], forces.phi[5:9].copy()
        view = kept[0][::2]
        del forces, frames
        gc.collect()
        for _ in range(5):
            pf.solve(RANDOM.integers(0, 255, (20, 32, 48), np.uint8))
        self.assertTrue(np.array_equal(kept, expected))
        self.assertTrue(np.array_equal(view, expected[0][::2]))
        kept *= 2
        np.from_dlpack(kept)

    def test_the_lock_is_released(self):
        frames = RANDOM.integers(0, 255, (400, 158, 158), np.uint8)
        turns = [0]
        solving = threading.Event()

        def turn():
            while solving.is_set():
                turns[0] += 1
                time.sleep(0)

        solving.set()
        thread = threading.Thread(target=turn)
        thread.start()
        for _ in range(50):  # On a busy machine the other thread may get no turn for a while.
            before = turns[0]
            pf.solve(frames)
            during = turns[0] - before
            if during > 100:
                break
        solving.clear()
        thread.join()
        self.assertGreater(during, 100)


    def test_threads_share_a_recording(self):
        WORK.mkdir(parents=True, exist_ok=True)
        path = WORK / "shared.h5"
        pf.save_recording(path, pf.simulate(skins.scene(100)), overwrite=True)
        code = ("import sys, threading, pillarfield as pf\n"
                "recording = pf.open(sys.argv[1])\n"
                "def work():\n"
                "    for _ in range(40): pf.solve(recording, baseline_time_s=1)\n"
                "threads = [threading.Thread(target=work) for _ in range(3)]\n"
                "for thread in threads: thread.start()\n"
                "for thread in threads: thread.join()\n")
        subprocess.run([sys.executable, "-c", code, path], check=True, timeout=600)


class Errors(unittest.TestCase):
    def test_text_place_and_mend(self):
        with self.assertRaises(pf.Error) as caught:
            pf.solve("missing.h5")
        self.assertEqual(str(caught.exception),
                         "missing.h5: No such file or directory; check its name")
        self.assertEqual((caught.exception.place, caught.exception.mend),
                         ("missing.h5", "check its name"))

    def test_wrong_calls(self):
        frames = np.zeros((2, 8, 12), np.uint8)
        wrong = [
            (pf.Error, lambda: pf.solve(np.zeros(8, np.uint8))),
            (pf.Error, lambda: pf.solve(np.zeros((2, 3, 8, 12)))),
            (pf.Error, lambda: pf.solve(np.array([["a", "b"]]))),
            (pf.Error, lambda: pf.solve(frames.astype(complex))),
            (pf.Error, lambda: pf.solve(np.zeros((1, 1, 1), np.uint8), layout="pillars")),
            (pf.Error, lambda: pf.solve([frames[0], frames[0][:4]])),
            (pf.Error, lambda: pf.solve(iter([frames[0], np.ma.array(frames[0], mask=True)]))),
            (pf.Error, lambda: pf.solve(frames, skin=pf.Skin(8, 14))),
            (pf.Error, lambda: pf.solve(frames, times=[1.0])),
            (pf.Error, lambda: pf.solve(frames, rate_hz=0)),
            (pf.Error, lambda: pf.solve(frames, estimator="field")),
            (pf.Error, lambda: pf.solve(frames, counts_per_newton=-1)),
            (pf.Error, lambda: pf.solve(frames, device="no such device")),
            (pf.Error, lambda: pf.solve(frames, calibration=pf.Calibration(8, 14))),
            (TypeError, lambda: pf.solve(frames, scene={"skin": 3})),
            (pf.Error, lambda: pf.solve(iter([]))),
            (pf.Error, lambda: pf.solve(iter([frames[0], frames[0][:4]]))),
            (pf.Error, lambda: pf.solve(iter([frames[0], 300 + frames[0].astype(int)]))),
            (pf.Error, lambda: pf.solve(frames).contacts),
            (TypeError, lambda: pf.solve(frames)[0][0])]
        for number, (kind, call) in enumerate(wrong):
            with self.subTest(number), self.assertRaises(kind):
                call()

    def test_one_line_names_the_argument_and_the_mend_in_words_of_python(self):
        frames = np.zeros((30, 8, 12), np.uint8)
        forces, skin = pf.solve(frames, counts_per_newton=320), pf.Skin(8, 12)
        path = WORK / "untimed.npy"
        np.save(path, frames)
        for words, call in (
                ("tare_frames: it is 10.5; give a whole number", lambda: pf.solve(frames, tare_frames=10.5)),
                ("Recording: tare_frames is 10.5; give a whole number", lambda: pf.Recording(path, tare_frames=10.5)),
                ("Skin: rows is 64.0; give a whole number", lambda: pf.Skin(64.0, 64)),
                ("Skin: cols is not given", lambda: pf.Skin(64)),
                ("Skin: counts_per_newton is 'many'; give a number", lambda: pf.Skin(8, 12, counts_per_newton="many")),
                ("outputs is 'angles'; give a list of texts", lambda: pf.solve(frames, outputs="angles")),
                ("friction is 'high'; give a number", lambda: pf.Plan(skin, friction="high")),
                ("none has the index 1000; give -30 to 29", lambda: forces[1000]),
                ("none has the index 1000", lambda: pf.Recording(path, rate_hz=10)[1000]),
                ("'a' is not an index", lambda: forces["a"]),
                ("give one, such as forces.normal", lambda: np.asarray(forces)),
                ("it has no uncertainty; solve with outputs=", lambda: forces.uncertainty),
                ("without pillars there is no magnitude", lambda: forces.magnitude),
                ("give a list of pairs", lambda: pf.calibrate.load(frames, 25.0)),
                ("frame 2 has the time 0.5; give finite times", lambda: pf.solve(frames[:3], times=[0, 1, 0.5])),
                ("give their rate with rate_hz=", lambda: pf.solve(path)),
                ("give noise_counts, or", lambda: pf.solve(frames, outputs=["uncertainty"]))):
            with self.subTest(words), self.assertRaises((pf.Error, TypeError)) as caught:
                call()
            self.assertIn(words, str(caught.exception))
            self.assertNotRegex(str(caught.exception), "\n|--")

    def test_what_is_not_there_is_no_attribute(self):
        forces = pf.solve(np.zeros((3, 8, 12), np.uint8), counts_per_newton=320)
        for name in ("magnitude", "theta", "shear_x", "region", "uncertainty", "intervals", "contacts"):
            self.assertFalse(hasattr(forces, name), name)
        known = pf.solve(np.zeros((3, 8, 12), np.uint8), counts_per_newton=320, noise_counts=1, outputs=["uncertainty"])
        self.assertTrue(hasattr(known, "uncertainty"))
        for part in (known.uncertainty, known.intervals):
            self.assertRegex(repr(part), r"^<\w+: normal[\w, ]*, 3 x 8 x 12>$")

    def test_an_exception_in_an_iterator_is_the_users(self):
        def broken():
            yield np.zeros((8, 12), np.uint8)
            raise KeyError("mine")

        with self.assertRaisesRegex(KeyError, "mine"):
            pf.solve(broken())

    def test_an_interrupt_ends_it(self):
        code = ("import itertools, os, signal, threading, numpy as np, pillarfield as pf\n"
                "threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT)).start()\n"
                "try: pf.solve(np.zeros((50_000_000, 64, 64), np.uint8), contacts=True)\n"
                "except KeyboardInterrupt: print('ended')\n")
        code = code.replace("np.zeros((50_000_000, 64, 64), np.uint8)",
                            "itertools.repeat(np.zeros((64, 64), np.uint8))")
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=600)
        self.assertEqual((done.stdout, done.returncode), ("ended\n", 0), done.stderr)


class Warnings(unittest.TestCase):
    FRAMES = np.zeros((3, 8, 12), np.uint8)
    FRAMES[:, :4] = 32

    def warnings_of(self, *arguments, **options):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            pf.solve(*arguments, **options)
        self.assertEqual({warning.filename for warning in caught} - {__file__}, set())
        return " ".join(str(warning.message) for warning in caught)

    def test_warns_unless_something_gives_counts_per_newton(self):
        for frames in (self.FRAMES, iter(self.FRAMES)):
            self.assertEqual(self.warnings_of(frames, calibration=pf.Calibration(8, 12)),
                             "The frames have no counts_per_newton; 320 is assumed.")
        calibration = pf.Calibration(8, 12, counts_per_newton=5)
        calibration.save(WORK / "scaled.h5", overwrite=True)
        for given in ({"counts_per_newton": 320}, {"skin": pf.Skin(8, 12, layout="pillars")},
                      {"calibration": calibration},
                      {"calibration": WORK / "scaled.h5"}):
            self.assertEqual(self.warnings_of(self.FRAMES, **given), "", given)
            self.assertEqual(self.warnings_of(iter(self.FRAMES), **given), "", given)
        self.assertEqual(self.warnings_of(pf.simulate(skins.scene())), "")

    def test_a_skin_without_layout_warns_where_frames_state_no_pillars(self):
        skin, path = pf.Skin(8, 12), WORK / "plain.npy"
        np.save(path, self.FRAMES)
        for frames, rate in ((self.FRAMES, {}), (iter(self.FRAMES), {}), (path, {"rate_hz": 50})):
            self.assertIn("states no layout", self.warnings_of(frames, skin=skin, **rate))
        for given in ({"layout": "sensels"}, {"layout": "pillars"}):
            self.assertEqual(self.warnings_of(self.FRAMES, skin=skin, **given), "")
        self.assertEqual(self.warnings_of(self.FRAMES, skin=pickle.loads(pickle.dumps(skin)), layout="pillars"), "")
        for use in (lambda: pf.Processor(pf.Plan(pickle.loads(pickle.dumps(skin)))),
                    lambda: pf.save_recording(WORK / "made.h5", self.FRAMES, skin=skin, overwrite=True),
                    lambda: pf.calibrate.tare(np.random.default_rng(1).normal(20, 1, (50, 8, 12)), skin=skin)):
            with self.assertWarnsRegex(UserWarning, "states no layout"):
                use()

    def test_an_assumed_pitch_is_said_with_a_pressure(self):
        with self.assertWarnsRegex(UserWarning, "pitch of 0.632 mm is assumed; give pitch_mm="):
            pf.solve(self.FRAMES, counts_per_newton=32).pressure()
        forces = pf.solve(self.FRAMES, counts_per_newton=32, pitch_mm=2)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertAlmostEqual(float(forces.pressure_kpa.max()), 250, places=3)

    def test_passes_on_the_warnings_about_a_file(self):
        path = WORK / "plain.npy"
        np.save(path, self.FRAMES)
        for frames in (path, pf.Recording(path, rate_hz=50)):
            rate = {"rate_hz": 50} if frames is path else {}
            self.assertIn("no counts_per_newton; 320 is assumed", self.warnings_of(frames, **rate))
            rest = self.warnings_of(frames, counts_per_newton=5, threshold_counts=4, **rate)
            self.assertIn("no sensel_pitch_mm", rest)
            self.assertNotIn("counts", rest)
            self.assertEqual(self.warnings_of(frames, skin=pf.Skin(8, 12, layout="pillars"), **rate), "")

    def test_warns_of_odd_sizes_and_of_readings_that_give_no_force(self):
        odd = np.pad(self.FRAMES, ((0, 0), (0, 1), (0, 1)))
        for frames in (odd, iter(odd)):
            self.assertEqual(self.warnings_of(frames, counts_per_newton=320), "")
            frames = iter(odd) if frames is not odd else odd
            warned = self.warnings_of(frames, counts_per_newton=320, layout="pillars")
            self.assertIn("last of the 9 sensel rows", warned)
            self.assertIn("last of the 13 sensel columns", warned)
        gone = self.FRAMES.astype(np.float32)
        gone[1] = np.nan
        for frames in (gone, iter(gone)):
            self.assertIn("In 1 of 3 frames no sensel has a reading",
                          self.warnings_of(frames, counts_per_newton=320))
        for value, words in ((0, "No sensel is in contact"), (32, "there is no tare")):
            self.assertIn(words, self.warnings_of(np.full_like(self.FRAMES, value), counts_per_newton=320))

    def test_noise_is_measured_in_steady_readings_of_good_sensels_within_their_range(self):
        random = np.random.default_rng(5)
        steady = np.full((300, 16, 16), 60.0)
        mostly_idle, mostly_saturated = steady.copy(), steady.copy()
        mostly_idle[:, :12] = -9
        mostly_saturated[:, :12] = 300
        jumping = steady * random.uniform(0.2, 3, (300, 1, 1)) * random.normal(1, 0.05, (16, 16))
        masked = np.ones((16, 16), np.uint8)
        masked[::2, ::2] = 0

        def is_told(load, noise, layout="pillars", mask=None):
            readings = np.rint(random.normal(load, noise)).clip(0, 255).astype(np.uint8)
            skin = pf.Skin(16, 16, layout=layout, counts_per_newton=320, full_scale_counts=255)
            calibration = pf.Calibration(16, 16, mask=mask, counts_per_newton=320)
            warned = self.warnings_of(readings, skin=skin, calibration=calibration, noise_counts=0.5)
            return "0.5 is stated" in warned

        self.assertTrue(is_told(mostly_idle, 1))
        self.assertTrue(is_told(mostly_saturated, 1))
        self.assertFalse(is_told(jumping, 0.4))
        self.assertFalse(is_told(steady, np.where(masked == 1, 0.4, 5), mask=masked))
        self.assertFalse(is_told(steady[:5], 2), "too few changes")
        self.assertFalse(is_told(steady, 2, layout="sensels"))

    def test_a_drift_before_the_touch_is_followed(self):
        random = np.random.default_rng(4)
        load = np.kron(np.geomspace(6, 120, 400).reshape(20, 20), np.ones((2, 2)))
        idle = random.normal(20, 0.5, (100, 40, 40)).astype(np.float32)
        skin = pf.Skin(40, 40, layout="pillars", counts_per_newton=320)
        tare = pf.calibrate.tare(idle, skin=skin)
        free = 20 + random.normal(size=load.shape) + random.normal(0, 0.5, (300, 40, 40))
        raw = (free + load * (np.arange(300) > 250)[:, None, None]).astype(np.float32)
        options = {"calibration": tare, "skin": skin, "rate_hz": 100, "threshold_counts": 8}
        self.assertIn("contradict each other", self.warnings_of(raw, **options))
        self.assertNotIn("parity", self.warnings_of(raw, baseline_time_s=0.3, **options))

    def test_axes_are_given(self):
        frames = RANDOM.integers(0, 200, (80, 12, 8)).astype(np.uint8)
        last, options = np.moveaxis(frames, 0, -1), {"counts_per_newton": 320}
        for axes in ("rows,columns,frames", ("rows", "columns", "frames")):
            self.assertTrue(same(pf.solve(last, axes=axes, **options), pf.solve(frames, **options)))
        with self.assertRaisesRegex(pf.Error, "3 axes"):
            pf.solve(last, axes="rows,columns")


if __name__ == "__main__":
    WORK.mkdir(parents=True, exist_ok=True)
    unittest.main()
