"""Forces for LeRobot: the columns of its datasets, and the plugin that shows a live skin as a camera."""

import importlib.metadata
import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

import numpy as np

import lerobot_stand_in as lerobot
import pillarfield as pf
import skins
from live_test import Sender, free_port, packet

SOURCE = pathlib.Path(os.environ["PILLARFIELD_SOURCE"])
WORK = pathlib.Path(os.environ["PILLARFIELD_WORK"])
READINGS = np.random.default_rng(3).integers(20, 120, (16, 24)).astype(np.uint8)
SHEAR_X, SHEAR_Y, NORMAL = (plane[0] for plane in skins.forces_of_region_one(READINGS[None]))
FULL_SCALE_N = 0.25

# A program that reads the source it is given until it ends, and that ends without disconnect().
PROGRAM = """
import sys
import lerobot_stand_in
import lerobot_camera_pillarfield as plugin
camera = plugin.PillarfieldCamera(plugin.PillarfieldCameraConfig(
    source=sys.argv[1], full_scale_n=1, counts_per_newton=320))
camera.connect(warmup=False)
try:
    for _ in range(int(sys.argv[2])):
        image = camera.async_read(60_000)
except ConnectionError as error:
    print(error)
print("done", image.shape)
"""


class Pattern(Sender):
    """Sends the readings again and again."""

    def readings(self):
        return READINGS


class Noisy(Pattern):
    """Every second frame reads one count more."""

    def readings(self):
        return READINGS + np.uint8(self.number % 2)


def setUpModule():
    """Installs the plugin with pip, where there is pip, and imports it as LeRobot does."""
    shutil.rmtree(WORK, ignore_errors=True)
    # A copy: pip leaves files beside the sources.
    shutil.copytree(SOURCE / "python/lerobot_camera_pillarfield", WORK / "source")
    name = "lerobot_camera_pillarfield"
    if all(importlib.util.find_spec(needed) for needed in ("pip", "setuptools", "wheel")):
        subprocess.run([sys.executable, "-m", "pip", "install", "-q", "--no-index", "--no-deps",
                        "--no-build-isolation", "--root-user-action=ignore", "--target", WORK / "site",
                        WORK / "source"], check=True)
        (project,) = importlib.metadata.distributions(path=[str(WORK / "site")])
        name = project.metadata["Name"].replace("-", "_")  # Setuptools before 69.0.3 makes hyphens.
    else:
        shutil.copytree(WORK / "source" / name, WORK / "site" / name)
    sys.path.insert(0, str(WORK / "site"))
    assert name.startswith("lerobot_camera_"), name
    importlib.import_module(name)


def camera_of(source, **options):
    """As make_device_from_device_class() of LeRobot finds it."""
    config = lerobot.CameraConfig.choices["pillarfield"]
    options = {"full_scale_n": FULL_SCALE_N, "counts_per_newton": skins.K, **options}
    package = sys.modules[config.__module__.rpartition(".")[0]]
    return getattr(package, config.__name__.removesuffix("Config"))(config(source=source, **options))


class Columns(unittest.TestCase):
    def check(self, columns, features, value):
        """What add_frame() checks: type and shape of each value of a frame."""
        (key, feature), = features.items()
        self.assertEqual((list(columns), key), ([key], "observation.tactile.left"))
        self.assertEqual((value.dtype, value.shape), (np.dtype(feature["dtype"]), feature["shape"]))
        self.assertEqual(len(feature["names"]), feature["shape"][-1])

    def test_forces_of_pillars_and_of_sensels(self):
        for layout, names, expected in (
                ("pillars", ["shear_x", "shear_y", "normal"], np.stack([SHEAR_X, SHEAR_Y, NORMAL], -1)),
                ("sensels", ["normal"], READINGS[..., None] / skins.K)):
            forces = pf.solve(np.stack([READINGS, READINGS // 2]), counts_per_newton=skins.K, layout=layout)
            columns, features = forces.to_lerobot("left")
            column = columns["observation.tactile.left"]
            self.check(columns, features, column[0])
            self.assertEqual(features["observation.tactile.left"]["names"], names)
            np.testing.assert_allclose(column[0], expected, atol=1e-6)
            np.testing.assert_array_equal(forces[1].to_lerobot()[0]["observation.tactile.skin"], column[1])

    def test_names_that_lerobot_refuses(self):
        for name in ("", "left/right"):
            with self.assertRaisesRegex(pf.Error, "not a name"):
                pf.solve(READINGS, counts_per_newton=skins.K).to_lerobot(name)


class Images(unittest.TestCase):
    def see(self, sender=Pattern, **options):
        port = free_port()
        with sender(port), camera_of(f"udp:127.0.0.1:{port}", **options) as camera:
            image = camera.async_read(60_000)
            self.assertEqual((camera.height, camera.width), image.shape[:2])
        self.assertEqual(image.dtype, np.uint8)
        return image

    def test_vectors_as_red_green_blue_and_normal_force_as_grey(self):
        shares = np.clip(np.stack([SHEAR_X, SHEAR_Y, NORMAL], -1) / FULL_SCALE_N, -1, 1)
        self.assertTrue((shares == 1).any() and (shares < 0).any())
        image = self.see(rendering="vector_rgb", layout="pillars")
        np.testing.assert_allclose(image, 128 + 127 * shares, atol=0.51)
        grey = 255 * np.clip(NORMAL / FULL_SCALE_N, 0, 1)
        np.testing.assert_allclose(self.see(layout="pillars"), np.stack([grey] * 3, -1), atol=0.51)

    def test_sensels_in_a_larger_image(self):
        image = self.see(width=48, height=40)
        self.assertEqual(image.shape, (40, 48, 3))
        grey = 255 * np.clip(READINGS / skins.K / FULL_SCALE_N, 0, 1)
        np.testing.assert_allclose(image[2::5, ::2, 0], grey[::2], atol=0.51)
        np.testing.assert_array_equal(image[:, ::2], image[:, 1::2])
        self.assertGreater(np.ptp(image[:, 0, 0]), 0)

    def test_tare(self):
        self.assertLess(self.see(Noisy, tare_frames=20).max(), 2)

    def test_a_calibration_gives_layout_and_scale(self):
        path = str(WORK / "skin.h5")
        unloaded = np.full((20, 16, 24), 5, np.uint8) + np.arange(20, dtype=np.uint8)[:, None, None] % 2
        tare = pf.calibrate.tare(unloaded, skin=pf.Skin(16, 24, layout="sensels")).calibration
        pf.calibrate.load([(READINGS[None], READINGS.sum() / 400)], tare).calibration.save(path)
        options = {"calibration": path, "counts_per_newton": None}
        forces = pf.solve(READINGS, calibration=path)
        grey = 255 * np.clip(forces.normal / FULL_SCALE_N, 0, 1)
        np.testing.assert_allclose(self.see(**options)[..., 0], grey, atol=0.51)
        with self.assertRaisesRegex(pf.Error, "no shear"):
            self.see(rendering="vector_rgb", **options)

    def test_what_is_refused(self):
        for message, options in (("no shear", {"rendering": "vector_rgb", "layout": "sensels"}),
                                 ("is none", {"rendering": "colour"}),
                                 ("full scale", {"full_scale_n": 0}),
                                 ("too few", {"tare_frames": 9}),
                                 ("leave out", {"width": 11, "height": 8}),
                                 ("counts_per_newton", {"counts_per_newton": None})):
            with self.assertRaisesRegex(pf.Error, message):
                self.see(**options)


class Reading(unittest.TestCase):
    def test_a_sensor_that_stops(self):
        port = free_port()
        camera = camera_of(f"udp:127.0.0.1:{port}")
        with self.assertRaises(lerobot.DeviceNotConnectedError):
            camera.read()
        with Pattern(port):
            camera.connect()
            with self.assertRaises(lerobot.DeviceAlreadyConnectedError):
                camera.connect()
            np.testing.assert_array_equal(camera.read(), camera.read_latest(60_000))
        with self.assertRaises(TimeoutError):
            for _ in range(10_000):  # More than wait.
                camera.async_read(300)
        self.assertEqual(camera.read_latest(600_000).shape, (16, 24, 3))
        with self.assertRaises(TimeoutError):
            camera.read_latest(0)
        camera.disconnect()
        self.assertFalse(camera.is_connected)
        with Pattern(port):
            camera.connect()
            camera.disconnect()

    def program(self, source, frames, **options):
        path = os.pathsep.join([str(WORK / "site"), os.environ["PYTHONPATH"]])
        done = subprocess.run([sys.executable, "-c", PROGRAM, source, str(frames)], capture_output=True,
                              env={**os.environ, "PYTHONPATH": path}, timeout=600, **options)
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        return done.stdout.decode()

    def test_a_source_that_ends(self):
        frames = b"".join(packet(READINGS, number) for number in range(50))
        self.assertEqual(self.program("-", 51, input=frames),
                         "PillarfieldCamera(-): the source ended.\ndone (16, 24, 3)\n")

    def test_a_program_that_ends_without_disconnect(self):
        port = free_port()
        with Pattern(port):
            self.assertEqual(self.program(f"udp:127.0.0.1:{port}", 3), "done (16, 24, 3)\n")


if __name__ == "__main__":
    unittest.main()
