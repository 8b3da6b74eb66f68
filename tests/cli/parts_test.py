"""Parts of a solve: their bits, joining, restarts, claims, hostile files."""

import fcntl
import json
import os
import shutil
import signal
import subprocess
import unittest

import h5py
import numpy

from command import BALL, PROGRAM, CommandTest, datasets, on_terminal, run, run_json

CARRYING = ("--estimator", "contact", "--follow-baseline", 0.05, "--noise", 0.5)


class PartsFolder(CommandTest):
    """A recording, and an output with its folder of parts."""

    def setUp(self):
        super().setUp()
        scene = self.folder / "ball.toml"
        scene.write_text(BALL.replace("frames = 6", "frames = 23"), encoding="utf-8")
        self.recording = self.folder / "rec.h5"
        self.output = self.folder / "out.h5"
        self.parts = self.folder / "out.h5.parts"
        run("simulate", scene, "-o", self.recording)

    def solve(self, *options, output=None, **how):
        return run("solve", self.recording, "-o", output or self.output, *options, **how)

    def solve_parts(self, count, *options):
        for part in range(count, 0, -1):
            self.solve(*options, "--part", f"{part}/{count}")

    def assert_same(self, one, other):
        """Both files hold the same objects and bits."""
        one, other = datasets(one), datasets(other)
        self.assertEqual(sorted(one), sorted(other))
        for name, values in one.items():
            self.assertEqual(values.dtype, other[name].dtype)
            self.assertEqual(values.tobytes(), other[name].tobytes(), name)


class PartsTest(PartsFolder):
    def test_joined_parts_equal_the_serial_solve(self):
        plans = (("--outputs", "angles,uncertainty,pressure", "--noise", 0.5), (),
                 (*CARRYING, "--checkpoint-every", 3, "--warm-up", 2))
        for plan in plans:
            serial = self.folder / "serial.h5"
            contacts = bool(plan) and plan[0] == "--estimator"
            with_contacts = lambda file: ("--contacts", file) if contacts else ()
            self.solve(*plan, *with_contacts(serial), output=serial)
            for count in (1, 5):
                shutil.rmtree(self.parts, ignore_errors=True)
                self.solve_parts(count, *plan, *with_contacts(self.output))
                run("join", self.output, "--overwrite")
                self.assert_same(serial, self.output)
        # A part is compared with its own frames.
        part = run("compare", self.parts / "00003.h5", self.recording, "--json").stdout
        self.assertLess(json.loads(part)["resultant"]["error_rms_n"], 1)

    def test_checkpoints(self):
        """Without effect up to the first; then state begins anew, less so after a warm-up."""
        def ids(*options):
            file = self.folder / "c.h5"
            self.solve(*CARRYING, "--contacts", file, *options, output=file)
            with h5py.File(file, "r") as found:
                return found["contacts/id"][()], found["force/normal"][()]
        plain = ids()
        late = ids("--checkpoint-every", 23)
        numpy.testing.assert_array_equal(plain[1], late[1])
        self.assertEqual(set(plain[0]), {1})
        cold, warm = (ids("--checkpoint-every", 10, "--warm-up", frames) for frames in (0, 9))
        self.assertEqual(set(cold[0]), {1, 2, 3})
        numpy.testing.assert_array_equal(cold[1][:10], plain[1][:10])
        error = [numpy.abs(each[1][10:] - plain[1][10:]).sum() for each in (cold, warm)]
        self.assertGreater(error[0], 0)
        self.assertLess(error[1], error[0])

    def test_a_checkpoint_begins_with_the_drift_so_far(self):
        """Beyond the threshold a sensel counts as touched, and its tare would follow no more."""
        frames = 240
        scene = self.folder / "drift.toml"
        scene.write_text(BALL.partition("[[contact]]")[0]
                         .replace("frames = 6", f"frames = {frames}")
                         .replace("threshold_counts = 2", "threshold_counts = 5"), encoding="utf-8")
        run("simulate", scene, "-o", self.recording, "--overwrite")
        with h5py.File(self.recording, "r+") as file:
            drift = numpy.linspace(0, 20, frames).astype("u1")
            file["frames/raw"][...] = file["frames/raw"][()] + drift[:, None, None]
        self.solve("--follow-baseline", 0.1, "--checkpoint-every", 40)
        with h5py.File(self.output, "r") as file:
            self.assertFalse(file["force/status"][()].any())

    def test_what_cannot_be_split_is_refused(self):
        part = ("-o", self.output, "--part", "2/3")
        for plan in (CARRYING, ("--contacts", self.output), ("--follow-baseline", 1)):
            self.assert_fails("solve", self.recording, *part, *plan,
                              names=["part 2 of 3", "--checkpoint-every"])
        self.assert_fails("solve", self.recording, "-o", self.output, "--part", "1/24",
                          names=["23 frames", "24 parts"])
        self.assert_fails("solve", self.recording, "-o", self.folder / "f.csv", "--part", "1/2",
                          names=["HDF5"])
        self.assert_fails("solve", self.recording, *part, "--contacts", self.folder / "c.csv",
                          names=["c.csv", "--contacts"])
        for wrong in ("0/3", "4/3", "1", "1/", "/3", "-1/3", "1/100000", "1/3x"):
            self.assert_fails("solve", self.recording, "-o", self.output, "--part", wrong, status=2)
        self.assert_folder_holds("ball.toml", "rec.h5")
        self.assert_fails("join", self.output, names=["00001.h5", "does not exist"])

    def test_a_restart_solves_what_is_missing(self):
        self.solve_parts(4)
        (self.parts / "00003.h5").unlink()
        (self.parts / "00004.h5").write_bytes((self.parts / "00004.h5").read_bytes()[:3000])
        (self.parts / "00003.h5.part").write_bytes(b"left by a killed process")
        self.assert_fails("join", self.output, names=["lacks 1 of 4 parts: 00003.h5"])

        def was_whole(part):
            return run_json("solve", self.recording, "-o", self.output, "--part",
                            f"{part}/4")["was_whole"]
        self.assertEqual([was_whole(part) for part in (1, 2, 3, 4)], [True, True, False, False])
        # Another plan, number of parts or recording is another solve.
        for change in (("--parity-tolerance", 9), ("--threshold", 5)):
            self.solve("--part", "2/4", *change)
            self.assert_fails("join", self.output, names=["differs from the other parts"])
            self.assertFalse(was_whole(2))
        with h5py.File(self.recording, "r+") as file:
            file["frames/raw"][11, 3, 3] += 1
        self.assertFalse(was_whole(2))
        # A repeated task of an array job, which counts anew, does not replace a part.
        before = (self.parts / "00002.h5").read_bytes()
        self.assert_fails("solve", self.recording, "-o", self.output, "--part", "2/5",
                          names=["00002.h5", "part 2 of 4", "--part K/4"])
        self.assertEqual((self.parts / "00002.h5").read_bytes(), before)

    def test_planes_that_differ_from_their_status_are_refused(self):
        self.solve_parts(3, "--outputs", "angles")
        with h5py.File(self.parts / "00002.h5", "r+") as file:
            frames = len(file["force/status"])
            del file["force/magnitude"]
            file["force/magnitude"] = numpy.ones((frames, 600, 600), "f4")
        self.assert_fails("join", self.output, names=["00002.h5", "magnitude", "differs in size"])

    def test_planes_longer_than_their_part_and_times_that_fall_are_refused(self):
        self.solve_parts(3)
        with h5py.File(self.parts / "00002.h5", "r+", libver="latest") as file:
            normal, times = file["force/normal"][()], file["force/time"][()]
            del file["force/normal"]
            file["force/normal"] = numpy.concatenate([normal, normal[:3]])
        self.assert_fails("join", self.output, names=["00002.h5", "/force/normal", "differs in size"])
        with h5py.File(self.parts / "00002.h5", "r+", libver="latest") as file:
            del file["force/normal"]
            file["force/normal"] = normal
            file["force/time"][:] = times - times[0]
        self.assert_fails("join", self.output, names=["00002.h5", "and the part before it"])
        self.assertFalse(self.output.exists())

    def test_trust_reaches_parts(self):
        """Untrusted frames have fewer values than these."""
        size = 3000
        self.solve_parts(2)
        for part in self.parts.iterdir():
            with h5py.File(part, "r+") as file:
                for name, plane in list(file["force"].items()):
                    if plane.ndim < 3:
                        continue
                    del file["force"][name]
                    file["force"].create_dataset(name, (len(plane), size, size), plane.dtype,
                                                 chunks=(1, 100, 100), fillvalue=0)
        self.assert_fails("join", self.output, names=["9000000", "--trust-input"])
        run("join", self.output, "--trust-input")

    def test_parts_that_claim_too_much_are_refused(self):
        self.solve_parts(2)
        for name, value in (("count", 1e18), ("count", 0), ("frames", -1), ("frames", 24),
                            ("frames", 2.0**45), ("checkpoint_every", float("nan"))):
            with h5py.File(self.parts / "00001.h5", "r+") as file:
                before = file["part"].attrs[name]
                file["part"].attrs[name] = value
            self.assert_fails("join", self.output, names=["out.h5.parts"])
            with h5py.File(self.parts / "00001.h5", "r+") as file:
                file["part"].attrs[name] = before
        run("join", self.output)

    def test_one_of_two_claimants_writes(self):
        self.parts.mkdir()
        claimed = self.parts / "00001.h5.part"
        with open(claimed, "wb") as file:
            fcntl.lockf(file, fcntl.LOCK_EX)
            self.assert_fails("solve", self.recording, "-o", self.output, "--part", "1/2",
                              names=["00001.h5", "being written by another process"])
        processes = [subprocess.Popen([PROGRAM, "solve", self.recording, "-o", self.output, "--part",
                                       "1/2", "-q"], stderr=subprocess.PIPE, text=True)
                     for _ in range(4)]
        messages = [process.communicate(timeout=600)[1] for process in processes]
        self.assertIn(0, [process.returncode for process in processes], messages)
        self.solve("--part", "2/2")
        run("join", self.output)
        self.solve(output=self.folder / "serial.h5")
        self.assert_same(self.output, self.folder / "serial.h5")

    def test_what_nothing_touches_takes_no_room(self):
        scene = self.folder / "large.toml"
        scene.write_text(BALL.replace("[20, 20]", "[240, 240]"), encoding="utf-8")
        recording = self.folder / "large.h5"
        run("simulate", scene, "-o", recording)
        for plan, planes in (((), 3), (("--outputs", "angles,uncertainty", "--noise", 0.5), 21)):
            run("solve", recording, "-o", self.output, *plan)
            dense = 6 * 240 * 240 * (4 * planes + 1)
            self.assertLess(self.output.stat().st_size, 0.05 * dense)
        with h5py.File(self.output, "r") as file:
            status, normal = file["force/status"][()], file["force/normal"][()]
            high = file["uncertainty/theta_high"][()]
        self.assertGreater(numpy.count_nonzero(status), 6 * 50)
        self.assertFalse(normal[status == 0].any())
        numpy.testing.assert_array_equal(high[status == 0], numpy.float32(numpy.pi / 2))

    def test_strips_of_skins_where_most_is_loaded(self):
        """Small planes are buffered for some frames, large ones written in place."""
        random = numpy.random.default_rng(5)
        for rows, cols, frames in ((120, 90, 37), (1230, 1000, 4)):
            raw = random.integers(60, 200, (frames, rows, cols), "u1")
            raw[1] = 0
            raw[2, :200], raw[3, 7:9, 5:] = 0, 0
            numpy.save(self.folder / "raw.npy", raw)
            plain = (self.folder / "raw.npy", "--rate", 100, "--threshold", 2, "--layout", "pillars")
            run("solve", *plain, "-o", self.output)
            run("solve", *plain, "-o", self.folder / "forces.npy")
            forces = numpy.load(self.folder / "forces.npy", mmap_mode="r")
            for part in (1, 2):
                run("solve", *plain, "-o", self.folder / "apart.h5", "--part", f"{part}/2")
            run("join", self.folder / "apart.h5", "--overwrite")
            for path in (self.output, self.folder / "apart.h5"):
                with h5py.File(path, "r") as file:
                    normal = file["force/normal"]
                    self.assertEqual(normal.chunks[2], cols // 2)
                    self.assertLess(normal.id.get_num_chunks(),
                                    -(-frames // normal.chunks[0]) * -(-rows // 2 // normal.chunks[1])
                                    + (normal.chunks[0] > 1))
                    for name in forces.dtype.names:
                        numpy.testing.assert_array_equal(file["force"][name][()], forces[name])


class ManyPartsTest(PartsFolder):
    FRAMES = 300

    def setUp(self):
        super().setUp()
        scene = self.folder / "ball.toml"
        scene.write_text(BALL.replace("frames = 6", f"frames = {self.FRAMES}"), encoding="utf-8")
        run("simulate", scene, "-o", self.recording, "--overwrite")
        self.solve("--part", f"1/{self.FRAMES}")
        for index in range(2, self.FRAMES + 1):
            part = self.parts / f"{index:05}.h5"
            shutil.copy(self.parts / "00001.h5", part)
            with h5py.File(part, "r+") as file:
                file["part"].attrs["index"] = float(index)
                file["force/time"][...] += index

    def test_ctrl_c_ends_long_work_and_leaves_nothing_half_written(self):
        def interrupt(process, messages):
            if "%" in messages:
                process.send_signal(signal.SIGINT)
            return "%" in messages
        def assert_interrupted(verb, *command):
            status, out, messages = on_terminal([PROGRAM, *map(str, command)], interrupt)
            self.assertEqual((status, out), (1, ""), messages)
            self.assertRegex(messages, f"{verb}: [a-z]+ [0-9]+ of [0-9]+ ")
            self.assertIn("interrupted", messages.splitlines()[-1])
            self.assert_folder_holds("ball.toml", "out.h5.parts", "rec.h5", *joined)
        joined = []
        assert_interrupted("Joining", "join", self.output)
        run("join", self.output)
        joined = ["out.h5"]
        before = self.output.read_bytes()
        assert_interrupted("Joining", "join", self.output, "--overwrite")
        self.assertEqual(self.output.read_bytes(), before)
        quiet = on_terminal([PROGRAM, "join", str(self.output), "--overwrite", "--quiet"])
        self.assertEqual(quiet, (0, "", ""))


if __name__ == "__main__":
    unittest.main()
