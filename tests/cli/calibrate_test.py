"""`pillarfield calibrate`: from a new skin to calibrated forces."""

import unittest

import h5py
import numpy

from command import CommandTest, datasets, run, run_json

SENSOR = """
[sensor]
adc_bits = 12
tare_counts = 12
tare_spread_counts = 1.5
gain_spread = 0.1
dead_zone_counts = 3
noise_counts = 1
dead_share = 0.003
"""
SIZE = 30  # pillars each way
PILLAR_AREA_MM2 = 4 * 0.632455532**2
FRAMES = 100
COUNTS_PER_NEWTON = 320

BALL = f"""
[skin]
pillars = [{SIZE}, {SIZE}]
[[contact]]
shape = "sphere"
motion = "slide"
friction = 0.4
contact_radius_mm = 12
reference_load_n = 60
path = [
  {{ time_s = 0, position_mm = [-4, 0], load_n = 60 }},
  {{ time_s = 4, position_mm = [4, 0], load_n = 60 }},
]
"""

class Calibrate(CommandTest):
    """All recordings have the same sensels and different frames of their noise."""

    first_frame = 0

    def record(self, name, load, sensor=SENSOR, frames=FRAMES):
        """Simulates `load` without calibration and returns the path of the recording."""
        scene = self.folder / f"{name}.toml"
        path = self.folder / f"{name}.h5"
        scene.write_text(load + sensor)
        last_frame = self.first_frame + frames
        run("simulate", scene, "-o", path, "--uncalibrated", "--frames", last_frame,
            "--overwrite")
        with h5py.File(path, "r+") as file:
            for dataset in ("frames/raw", "frames/time", "truth/shear_x", "truth/shear_y",
                            "truth/normal"):
                values = file[dataset][self.first_frame:]
                del file[dataset]
                file[dataset] = values
        self.first_frame = last_frame
        return path

    def unloaded(self, **options):
        return self.record("unloaded", f"[skin]\npillars = [{SIZE}, {SIZE}]\n", **options)

    def pressed(self, newtons, **options):
        """A load of `newtons` on every pillar."""
        return self.record(f"pressed_{newtons}",
                           f"[direction_sweep]\ndirections = {SIZE}\ninclinations = {SIZE}\n"
                           f"max_theta_deg = 0\nmagnitudes_n = [{newtons}]\n", **options)

    def pressure_kpa(self, newtons):
        return 1000 * newtons / PILLAR_AREA_MM2

    def tared(self):
        calibration = self.folder / "tared.h5"
        return calibration, run_json("calibrate", "tare", self.unloaded(), "-o", calibration)

    def error_of(self, recording, *options):
        forces = self.folder / "forces.h5"
        run("solve", recording, "-o", forces, *options)
        return run_json("compare", forces, recording)["regions"]["1"]["rms_n"]


class Chain(Calibrate):
    def test_from_a_new_skin_to_forces(self):
        tared, tare = self.tared()
        self.assertAlmostEqual(tare["tare_counts"], 12, delta=0.2)
        self.assertAlmostEqual(tare["noise_counts"], 1.04, delta=0.03)
        # A dead sensel reads 0 where all others rest clear of it, as one that is absent.
        self.assertTrue(all(finding["fault"] == "absent" and finding["masked"]
                            for finding in tare["findings"]))
        self.assertEqual(tare["masked"], len(tare["findings"]))
        known = self.folder / "known_sensels.h5"
        run("simulate", self.folder / "unloaded.toml", "-o", known, "--frames", 1)
        with h5py.File(known) as file:
            self.assertEqual([(finding["row"], finding["col"]) for finding in tare["findings"]],
                             list(zip(*numpy.where(file["calibration/mask"][:] == 0))))

        low, high = self.pressed(0.2), self.pressed(0.7)
        equal = self.folder / "equal.h5"
        pressures = f"{self.pressure_kpa(0.2)},{self.pressure_kpa(0.7)}"
        result = run_json("calibrate", "equilibrate", low, high, "--pressure-kpa", pressures,
                          "--calibration", tared, "-o", equal)
        self.assertEqual(result["levels"], 2)
        self.assertAlmostEqual(result["gain_spread"], 0.1, delta=0.01)
        self.assertAlmostEqual(result["dead_zone_counts"], 3, delta=0.1)
        self.assertLess(result["unevenness"], 0.02)
        self.assertEqual(result["findings"], [])

        loaded = self.folder / "loaded.h5"
        pillars = SIZE * SIZE
        result = run_json("calibrate", "load", high, "--load-n", 0.7 * pillars, low, "--load-n",
                          0.2 * pillars, "--calibration", equal, "-o", loaded)
        self.assertLess(result["misfit"], 2e-3)
        # The mean of the gains is 1; that of the true gains is larger by the square of the spread.
        self.assertAlmostEqual(result["counts_per_newton"], COUNTS_PER_NEWTON / 1.01, delta=1.5)
        self.assertEqual([load["saturated"] for load in result["loads"]], [0, 0])

        ball = self.record("ball", BALL, frames=50)
        found = self.error_of(ball, "--calibration", loaded)
        without = self.error_of(ball)
        with_truth = self.folder / "known.h5"
        scene = self.folder / "ball.toml"
        run("simulate", scene, "-o", with_truth, "--frames", 50)
        reference = self.error_of(with_truth, "--threshold", 5)
        self.assertLess(found, 1.1 * reference)
        self.assertGreater(without, 3 * reference)

        copy, before = self.folder / "copy.h5", ball.read_bytes()
        run("calibrate", "apply", loaded, ball, "-o", copy)
        self.assertEqual(ball.read_bytes(), before)
        new = datasets(copy)
        for source, names in ((ball, ("frames/raw", "frames/time", "truth/shear_x", "truth/normal")),
                              (loaded, ("calibration/tare", "calibration/gain", "calibration/mask"))):
            for name in names:
                old = datasets(source)[name]
                self.assertEqual((old.dtype, old.tobytes()), (new[name].dtype, new[name].tobytes()))
        self.assertAlmostEqual(self.error_of(copy), found, delta=1e-9)

        facts = run_json("info", loaded)
        self.assertEqual(facts["planes"], ["tare", "gain", "dead_zone", "mask", "noise"])
        self.assertEqual([step["step"] for step in facts["history"]],
                         ["tare", "equilibrate", "load"])
        self.assertEqual(facts["history"][1]["sources"], ["pressed_0.2.h5", "pressed_0.7.h5"])
        self.assertEqual(facts["history"][1]["frames"], 2 * FRAMES)
        self.assertIn("linear", facts["history"][2]["parameters"])
        self.assertRegex(facts["history"][0]["date_utc"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
        text = run("info", loaded).stdout
        self.assertIn("step equilibrate, sources pressed_0.2.h5 pressed_0.7.h5, frames 200", text)

    def test_a_log_of_pressure_is_read_strictly(self):
        tared, equal = self.folder / "tared.h5", self.folder / "equal.h5"
        run("calibrate", "tare", self.unloaded(), "-o", tared)
        pressed = self.pressed(0.5)
        run("calibrate", "equilibrate", pressed, "--pressure-kpa", 312.5, "--calibration", tared,
            "-o", equal)
        log = self.folder / "log.csv"
        step = ("calibrate", "memory", pressed, "--pressure", log, "--calibration", equal, "-o",
                self.folder / "memory.h5")
        for text, fault in (("", "no pressure"), ("time_s,pressure_kpa\n", "no pressure"),
                            ("0,1\n0,2\n", "log.csv:2"), ("0,1\nx,2\n", "log.csv:2"),
                            ("0\n", "log.csv:1"), ("0,-1\n", "log.csv:1"), ("0,nan\n", "log.csv:1"),
                            ("t,p\n0,1,2\n", "log.csv:2"), ("0,1\n", "does not change")):
            log.write_text(text)
            self.assert_fails(*step, names=[fault])
        log.unlink()
        self.assert_fails(*step, names=["log.csv"])


class WrongInput(Calibrate):
    """Wrong input ends with one line and exit status 1, and writes nothing."""

    def assert_refused(self, *arguments, names):
        output = self.folder / "new.h5"
        self.assert_fails("calibrate", *arguments, "-o", output, names=names)
        self.assertFalse(output.exists())
        self.assertFalse((self.folder / "new.h5.part").exists())

    def test_of_every_kind(self):
        tared, _ = self.tared()
        bare = self.unloaded(frames=40)
        ball = self.record("ball", BALL, frames=20)
        small = self.record("small", f"[skin]\npillars = [{SIZE}, 20]\n", frames=20)
        absent = self.folder / "absent.h5"
        sizes = ["60 x 40", "60 x 60"]
        for names, *arguments in (
                (["ball.h5", "touched", "preloaded"], "tare", ball),
                (sizes, "tare", small, "--calibration", tared),
                (["unloaded.h5", "not respond"], "equilibrate", bare, "--pressure-kpa", 100, "--calibration", tared),
                (["unloaded.h5", "no contact"], "load", bare, "--load-n", 20, "--calibration", tared),
                (["no sensel moved"], "faults", bare, "--calibration", tared),
                (["unloaded.h5", "pillarfield-recording"], "faults", ball, "--calibration", bare),
                (["absent.h5", "No such file"], "faults", ball, "--calibration", absent),
                (sizes, "apply", tared, small), (["tared.h5", "a calibration"], "apply", tared, tared)):
            self.assert_refused(*arguments, names=names)
        self.assert_fails("solve", small, "--calibration", tared, "-o", self.folder / "new.h5",
                          names=["small.h5", *sizes])


if __name__ == "__main__":
    unittest.main()
