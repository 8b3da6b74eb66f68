"""Names of columns and axes of arrays that say what readings are, in worlds drawn by chance: each reading comes to its
place, or the file is refused with a line that brings it there, or with an honest question. SEEDS sets their number."""

import collections
import os
import pathlib
import re
import shlex
import subprocess
import tempfile
import unittest

import h5py
import numpy as np

import pillarfield as pf

SEEDS = int(os.environ.get("SEEDS", "20"))
FOREIGN = ("temperature", "battery", "imu_x", "imu_y", "gyro_z", "frame", "seq", "label", "host_time", "speed", "knob",
           "Trigger", "valid", "cop_x", "emg1 emg2", "rssi", "motor_1 motor_2 motor_3", "X Y Z", "width")
OPTION = re.compile(r"--(?:columns|where|axes) '[^']*'|--shape ROWSxCOLS|--rate HZ")


class Table:
    """A table [lines, columns] of readings of known places, and columns of other things."""

    def __init__(self, seed):
        self.random = random = np.random.default_rng([seed, 4])
        self.kind = random.choice(["index", "place", "index", "place", "sides", "letters", "components", "pads", "lines"])
        self.rows, self.cols = random.integers(2, 9), random.integers(2, 14)
        base, pad = random.integers(2), random.choice(["{}", "{:02d}", "{:03d}"])
        stem = random.choice(["data[#]", "/pad/data[#]", "s#", "p #", "ch#", "sensor_#", "taxel#_raw", "FSR-#", "v(#)"])
        stem += random.choice(["", "", " [kPa]", "_counts"])
        number = lambda i: pad.format(i + base)  # noqa: E731
        if self.kind in ("sides", "letters"):
            self.rows = 2 if self.kind == "sides" else self.rows
            words = random.choice(["left right", "L R"]).split() if self.kind == "sides" else "ABCDEFGHI"
            mid = random.choice(["_", "_ch", " "]) if self.kind == "sides" else ""
            named = lambda r, c: words[r] + mid + number(c)  # noqa: E731
        elif self.kind == "place":
            scheme = random.choice(["r%sc%s", "row%s_col%s", "p[%s][%s]", "R%s_C%s", "m_%s_%s", "x%sy%s", "col%srow%s"])
            swap = scheme[0] in "xc"
            named = lambda r, c: scheme % ((number(c), number(r)) if swap else (number(r), number(c)))  # noqa: E731
        else:
            named = lambda r, c: stem.replace("#", number(r * self.cols + c))  # noqa: E731
        self.truth = random.integers(1, 250, (12, self.rows, self.cols)).astype(float)
        cells = [(r, c) for r in range(self.rows) for c in range(self.cols)]
        columns = {named(r, c): self.truth[:, r, c] for r, c in cells}
        if self.kind == "components":
            form = random.choice(["f$_#", "#_$", "#.$", "F$#", "force_$_#"])
            quantities = ["", "d"] if form == "f$_#" and random.random() < 0.5 else [""]
            columns, normals = {}, []
            for index, (r, c) in enumerate(cells):
                for quantity in quantities:
                    for axis in random.permutation(["x", "y", "z"]) if form == "#_$" else "xyz":
                        name = (form if not quantity else "d$_#").replace("$", axis).replace("#", number(index) if form == "F$#" else "p" + number(index))
                        is_normal = axis == "z" and not quantity
                        normals += [name] if is_normal else []
                        columns[name] = self.truth[:, r, c] if is_normal else random.normal(0, 9, 12).round(2)
        if self.kind == "pads":
            columns = {f"pad{pad}_{name}": value * (1 if pad == 0 else 2) for pad in range(2)
                       for name, value in columns.items()}
        names = list(columns)
        order = random.choice(["natural", "alphabet", "shuffled", "columns first"])
        if order == "alphabet":
            names.sort()
        elif order == "shuffled":
            random.shuffle(names)
        elif order == "columns first" and len(names) == len(cells):
            names = [names[r * self.cols + c] for c in range(self.cols) for r in range(self.rows)]
        self.readings = list(columns)
        if self.kind == "components":
            self.readings = normals
        if self.kind == "sides" and names[0] != self.readings[0] and names[0][0] == words[1][0]:
            self.truth = self.truth[:, ::-1]  # The side that comes first is the first row.
            self.readings = self.readings[self.cols:] + self.readings[:self.cols]
        for group in random.choice(FOREIGN, random.integers(4), replace=False):
            at = random.integers(len(names) + 1)
            for name in group.split():
                columns[name] = np.repeat(["sit", "walk"], 6) if name == "label" else random.normal(20, 3, 12).round(2)
                names.insert(at, name)
        self.is_timed = random.random() < 0.5
        if self.is_timed:
            names.insert(0, "time")
            columns["time"] = np.arange(12) / 50
        lines = [[columns[name][t] for name in names] for t in range(12)]
        if self.kind == "lines":  # Two sides take turns.
            names.insert(0, "side")
            words = random.choice(["L R", "left right", "0 1"]).split()
            lines = [[word] + [cell if isinstance(cell, str) or name == "time" else cell * (1 + 2 * (word == words[1]))
                               for cell, name in zip(line, names[1:])] for line in lines for word in words]
        self.text = "\n".join([",".join(names), *(",".join(map(str, line)) for line in lines)]) + "\n"
        self.names = names
        self.gives_shape = self.kind != "place" or random.random() < 0.3


class DataFrame:
    """What the package uses of pandas."""

    index = type("RangeIndex", (), {"name": None})()

    def __init__(self, text):
        self.text = text
        self.columns = text.split("\n")[0].split(",")

    def to_csv(self, path, header, index, index_label):
        pathlib.Path(path).write_text(self.text)


class Names(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def solve(self, path, *options):
        """The command's normal forces, or its error."""
        output = self.folder / "forces.npy"
        run = subprocess.run([os.environ["PILLARFIELD"], "solve", path, "--counts-per-newton", "1", "--threshold",
                              "0", "--estimator", "direct", "-o", output, "--overwrite", *options],
                             capture_output=True, text=True, cwd=self.folder)
        self.assertIn(run.returncode, (0, 1, 2), run.stderr)
        return (np.load(output)["normal"], "") if run.returncode == 0 else (None, run.stderr)

    def hinted(self, path, given, error, rows, cols):
        """The result of the line that an error proposes, run, with the answers to its placeholders."""
        words = " ".join(OPTION.findall(error)).replace("ROWSxCOLS", f"{rows}x{cols}").replace("HZ", "50")
        found, again = self.solve(path, *given, *shlex.split(words))
        self.assertIsNotNone(found, f"{error}\n{words}\n{again}")
        return found

    def test_each_reading_of_a_table_comes_to_its_place(self):
        rates = collections.Counter()
        for seed in range(SEEDS):
            with self.subTest(seed=seed):
                world = Table(seed)
                path = self.folder / "table.csv"
                path.write_text(world.text)
                given = [] if world.is_timed else ["--rate", "50"]
                if world.gives_shape:
                    given += ["--shape", f"{world.rows}x{world.cols}"]
                found, error = self.solve(path, *given)
                how = "right"
                note = f"{world.kind}\n{world.text.splitlines()[0]}\n{error}"
                if found is None and "choose" in error and not OPTION.search(error):
                    how = "asked"  # Who knows the answer gives it.
                    chosen = ",".join(world.readings if world.kind != "pads" else world.readings[:world.rows * world.cols])
                    if not world.gives_shape:
                        given += ["--shape", f"{world.rows}x{world.cols}"]
                    found, error = self.solve(path, *given, "--columns", chosen)
                    if found is None:
                        found = self.hinted(path, [*given, "--columns", chosen], error, world.rows, world.cols)
                elif found is None:
                    how = "hinted"
                    found = self.hinted(path, given, error, world.rows, world.cols)
                if world.kind in ("components", "pads", "lines"):
                    self.assertNotEqual(how, "right", note)
                np.testing.assert_array_equal(found, world.truth, note)
                rates[world.kind, how] += 1
        print("tables:", dict(sorted(rates.items())))

    def test_python_takes_what_its_messages_offer(self):
        frames = np.random.default_rng(1).integers(1, 200, (12, 2, 3))
        names = ["time", *(f"s{i}" for i in range(6)), "side"]
        table = np.column_stack([np.arange(12) / 50, frames.reshape(12, 6), np.tile([0, 1], 6)])
        text = "\n".join([",".join(names), *(",".join(f"{cell:g}" for cell in line) for line in table)])
        (self.folder / "t.csv").write_text(text)
        for given in (DataFrame(text), self.folder / "t.csv"):
            with self.assertRaisesRegex(pf.Error, "where='side=0'"):
                pf.solve(given, frame_size=(2, 3))
            options = {"where": "side=1", "columns": "2-7", "frame_size": (2, 3)}
            forces = pf.solve(given, counts_per_newton=1, threshold_counts=0, **options)
            np.testing.assert_array_equal(forces.normal, frames[1::2])
            with self.assertRaisesRegex(pf.Error, "at least 10|fewer"):
                pf.doctor(given, **options)
            with self.assertRaisesRegex(pf.Error, "20"):
                pf.calibrate.tare(given, **options)
        for words, call in (("bool", lambda: pf.solve(frames > 9)), ("dict of 'a'", lambda: pf.solve({"a": frames})),
                            ("'pitch_mm'", lambda: pf.solve(frames, sensel_pitch_mm=2)),
                            ("'sensel_pitch_mm'", lambda: pf.Skin(2, 3, pitch_mm=2)),
                            ("no argument 'unit'", lambda: pf.calibrate.tare(frames, unit="N")),
                            ("'picture'", lambda: pf.solve(frames).plot()),
                            ("timeout: it is nan", lambda: pf.live("-", timeout=np.nan))):
            with self.assertRaisesRegex((pf.Error, TypeError), words):
                call()
        pads = np.zeros((40, 32, 32), np.uint8)
        for pad in range(40):
            pads[pad, pad * 7 % 28:pad * 7 % 28 + 4, pad * 11 % 28:pad * 11 % 28 + 4] = 50
        with self.assertWarnsRegex(UserWarning, "unrelated_frames=True"):
            pf.solve(pads, counts_per_newton=100)

    def test_axes_of_components_and_pads_are_no_sensels(self):
        rates = collections.Counter()
        for seed in range(SEEDS):
            with self.subTest(seed=seed):
                random = np.random.default_rng([seed, 5])
                kind = random.choice(["taxels", "last", "planes", "frame", "pads", "pads of three"])
                rows, cols = random.integers(4, 12, 2)
                count = 1 if kind == "frame" else random.integers(12, 40)
                touch = random.random((count, rows, cols)) < 0.2
                touch[:count // 3 * (count > 1)] = False
                normal = np.where(touch, random.gamma(4, 0.5, touch.shape), 0)
                angle, friction = random.uniform(*((3.5, 6) if kind == "frame" else (0, 7))), random.uniform(0.3, 0.7)
                shear = [friction * normal * np.cos(angle), friction * normal * np.sin(angle)]
                first = kind in ("planes", "frame") and random.random() < 0.5
                force = np.stack([normal, *shear] if first else [*shear, normal])
                force += random.choice([0, 1]) * random.normal(0, 0.01, force.shape)
                normal = np.maximum(force[0 if first else 2], 0)
                force[0 if first else 2] = normal
                array = {"taxels": lambda: np.moveaxis(force, 0, -1).reshape(count, rows * cols, 3),
                         "last": lambda: np.moveaxis(force, 0, -1), "planes": lambda: np.moveaxis(force, 0, 1),
                         "frame": lambda: force[:, 0],
                         "pads": lambda: np.stack([normal, 2 * normal, 3 * normal, normal], 1),
                         "pads of three": lambda: np.stack([np.moveaxis(force, 0, -1)] * 2, 1)}[kind]().astype(np.float32)
                place = random.choice(["a.npy", "a.npz", "a.h5"])
                if place == "a.h5":
                    with h5py.File(self.folder / place, "w") as file:
                        file["pads"] = array
                else:
                    (np.save if place == "a.npy" else lambda at, it: np.savez(at, pads=it, rates=[1.0]))(
                        self.folder / place, array)
                options = ["--rate", "50", *(["--dataset", "pads"] if place == "a.h5" else [])]
                found, error = self.solve(place, *options)
                self.assertIsNone(found, f"{kind} {array.shape}")
                line = re.search(r"run (python3 -c \".*\"), and give its file( with --shape ROWSxCOLS)?", error)
                self.assertTrue(line and "[K" not in error and ", K" not in error, f"{kind} {error}")
                environment = dict(os.environ, PATH="/usr/bin:" + os.environ["PATH"])
                subprocess.run(line[1], shell=True, cwd=self.folder, check=True, env=environment)
                shape = ["--shape", f"{rows}x{cols}"] if line[2] else [] if kind != "frame" else ["--axes", "rows,columns"]
                found, error = self.solve("a_part.npy", "--rate", "50", *shape)
                np.testing.assert_array_equal(found.reshape(normal.shape), normal.astype(np.float32), error)
                with self.assertRaises(pf.Error) as refused:
                    pf.solve(array, counts_per_newton=1)
                words = refused.exception.mend.split(";")[0].removeprefix("give ")
                part = eval(words, {"frames": array, "ROWS": rows, "COLS": cols})  # noqa: S307
                np.testing.assert_array_equal(part.reshape(normal.shape), normal.astype(np.float32))
                rates[kind] += 1
        print("arrays:", dict(sorted(rates.items())))


if __name__ == "__main__":
    unittest.main()
