"""Texts of random words, sizes, units and noise: each is read right, or refused in one line.

SEEDS (20) worlds of each kind; rates by kind are printed.
"""

import collections
import os
import pathlib
import unittest
import warnings

import numpy as np

import pillarfield as pf

WORK = pathlib.Path(os.environ["PILLARFIELD_WORK"])
WORK.mkdir(parents=True, exist_ok=True)
SEEDS = int(os.environ.get("SEEDS", "20"))
KPA = {"kPa": 1.0, "kpa": 1.0, "kilopascals": 1.0, "kN/m2": 1.0, "psi": 6.894757, "PSI": 6.894757, "lbf/in2": 6.894757,
       "mmHg": 0.1333224, "mm Hg": 0.1333224, "N/cm2": 10.0, "N/cm^2": 10.0, "N / cm²": 10.0, "N/mm2": 1000.0,
       "MPa": 1000.0, "Pa": 1e-3, "hPa": 0.1, "mbar": 0.1, "bar": 100.0, "kgf/cm2": 98.0665, "g/cm2": 0.0980665,
       "Torr": 0.1333224, "cmH2O": 0.0980665}
NEWTONS = {"N": 1.0, "newtons": 1.0, "kgf": 9.80665, "g": 0.00980665, "lbf": 4.448222}
UNKNOWN = ["furlongs", "cd/m2", "kPaa", "quux"]
SIZES = ["Sensel spacing ({u}): {w} x {h}", "Sensel dimensions: {w} {u} (W) x {h} {u} (H)", "Spacing ({u}),{w},{h}",
         "Sensel size (HxW) [{u}]: {h} x {w}", "Row spacing {h} {u}, column spacing {w} {u}",
         '"cell_size_x","{w}","cell_size_y","{h}","unit","{u}"', "Pitch x: {w} {u}, y: {h} {u}",
         "Sensel width: {w} {u}\nSensel height: {h} {u}", "Cell size: {w}{u}x{h}{u}", "Taxel pitch {w} {u} by {h} {u}",
         "Element size, W x H: {w} x {h} {u}", "Sensel Width ({u}),{w}\nSensel Height ({u}),{h}",
         "Sensel dimensions (rows x columns): {h} × {w} {u}", "sensel pitch: W={w} H={h} {u}",
         "Sensel size {h} {u} high, {w} {u} wide", "Sensels of {w} {u} and height"]


def outcome(read, is_right):
    """'right', 'refused' in one line, 'warned' that counts are assumed, or 'WRONG'."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            result = read()
        except pf.Error as error:
            assert "\n" not in str(error), error
            return "refused"
    said = " ".join(str(each.message) for each in caught)
    if is_right(result, said):
        return "right"
    return "warned" if "counts_per_newton; 320 is assumed" in said else "WRONG"


class Texts(unittest.TestCase):
    def judge(self, kind, world, least):
        """Counts the outcomes of random worlds by kind."""
        rates, wrong = collections.defaultdict(collections.Counter), []
        for seed in range(SEEDS):
            random = np.random.default_rng([seed, *kind.encode()])
            name, read, is_right, text = world(random, WORK / f"{kind}.txt")
            found = outcome(read, is_right)
            rates[name][found] += 1
            if found == "WRONG":
                wrong.append(f"seed {seed}, {name}:\n{text[:1500]}")
        for name in sorted(rates):
            print(kind, name, dict(rates[name]))
        self.assertFalse(wrong, "\n".join(wrong[:2]))
        right = sum(each["right"] for each in rates.values())
        self.assertGreaterEqual(right, least * SEEDS, rates)

    def test_sizes_in_heads(self):
        def world(random, path):
            unit, mm = [("mm", 1), ("cm", 10), ("in", 25.4), ("inches", 25.4)][random.integers(4)]
            w, h = (float(f"{x / mm:.4g}") for x in random.uniform(2, 30, 2))
            template = SIZES[random.integers(len(SIZES))]
            line = template.format(w=w, h=h, u=unit)
            cells = random.uniform(0, 90, (3, *random.integers(2, 9, 2))).round(2)
            text = f"{line}\nUnits: kPa\n" if random.random() < 0.5 else f"Units: kPa\n{line}\n"
            if random.random() < 0.5:
                text += "".join(f"Frame {i + 1}\n" + "".join(",".join(map(str, row)) + "\n" for row in frame)
                                for i, frame in enumerate(cells))
            else:
                text += "time," + ",".join(f"s{i}" for i in range(cells[0].size)) + "\n" + "".join(
                    f"{i / 50}," + ",".join(map(str, frame.ravel())) + "\n" for i, frame in enumerate(cells))
            path.write_text(text)
            pitch = None if random.random() < 0.6 else tuple(float(x) for x in random.uniform(2, 30, 2).round(2))
            rows_mm, cols_mm = pitch or (h * mm, w * mm)
            newtons = cells.sum(axis=(1, 2)) * rows_mm * cols_mm / 1000

            def read():
                recording = pf.Recording(path, pitch_mm=pitch, frame_size=cells.shape[1:],
                                         rate_hz=None if "time," in text else 50)
                for warning in recording.warnings:
                    warnings.warn(warning)
                found = recording.skin.sensel_pitch_mm
                return (pf.solve(recording).normal.sum(axis=(1, 2)),
                        found if isinstance(found, tuple) else (found, found))

            def is_right(result, said):
                return (np.allclose(result[0], newtons, rtol=1e-3)
                        and np.allclose(result[1], (rows_mm, cols_mm), rtol=1e-3)
                        and (pitch is None or "{h}" not in template or "is used" in said))
            return ("given" if pitch else "stated") + " " + template.replace("\n", " / "), read, is_right, text
        self.judge("sizes", world, 0.85)

    def test_units_in_heads(self):
        def world(random, path):
            known = {**KPA, **NEWTONS}
            unit = [*known, *UNKNOWN][random.integers(len(known) + len(UNKNOWN))]
            style = ["Units: {}", "Unit;{}", "Pressure values in {}", "Readings [{}]", "names", "given",
                     "% unit = {}", "array"][random.integers(8)]
            cells = random.uniform(1, 90, (4, 3, 5)).round(2)
            area = float(random.uniform(20, 400))
            names = [f"p{i} ({unit})" if style == "names" else f"s{i}" for i in range(15)]
            text = "" if style in ("names", "given", "array") else style.format(unit) + "\n"
            text += "time," + ",".join(names) + "\n"
            text += "".join(f"{i / 10}," + ",".join(map(str, frame.ravel())) + "\n" for i, frame in enumerate(cells))
            path.write_text(text)
            each = NEWTONS[unit] if unit in NEWTONS else KPA.get(unit, np.nan) * area / 1000

            def read():
                if style == "array":
                    return pf.solve(cells, readings=unit, pitch_mm=area**0.5).normal.sum(axis=(1, 2))
                recording = pf.Recording(path, pitch_mm=area**0.5, frame_size=(3, 5),
                                         readings=unit if style == "given" else "")
                for warning in recording.warnings:
                    warnings.warn(warning)
                return pf.solve(recording).normal.sum(axis=(1, 2))
            kind = "unknown" if unit in UNKNOWN else "force" if unit in NEWTONS else "pressure"
            return f"{kind} {style}", read, lambda newtons, _: np.allclose(
                newtons, cells.sum(axis=(1, 2)) * each, rtol=1e-3), text
        self.judge("units", world, 0.6)

    def test_logs_of_serial_monitors(self):
        def world(random, path):
            rows, cols = (int(n) for n in random.integers(2, 13, 2))
            frames = random.integers(0, 1000, (int(random.integers(8, 40)), rows, cols))
            style = ["line", "blank", "dashes", "words", "numbered"][random.integers(5)]
            stamps, separator = random.random() < 0.5, [",", " ", ";", "\t", ", "][random.integers(5)]
            noise = ["Calibrating...", "RA,6", "CN_MM", "wifi: connected", "ERR 17 timeout", "free heap low"]
            cut = {i for i in range(len(frames)) if random.random() < 0.08} | {0, len(frames) - 1}
            clock, lines = 43199.5 + random.uniform(-9, 3), []

            def say(line):
                nonlocal clock
                clock += 0.01
                stamp = f"{int(clock // 3600):02d}:{int(clock // 60) % 60:02d}:{clock % 60:06.3f} -> "
                lines.append((stamp if stamps else "") + line)
            for _ in range(random.integers(0, 3)):
                say(["Velostat matrix ready", "-- start --", "setup done", "// mat v2", "% log"][random.integers(5)])
            for i, frame in enumerate(frames):
                if style == "numbered":
                    say(f"Frame {i + 7}")
                texts = [separator.join(map(str, row)) for row in frame]
                if style == "line":
                    texts = [separator.join(texts)]
                for at, line in enumerate(texts):
                    is_cut = i in cut and at == (len(texts) - 1 if i else 0)
                    if is_cut and i and len(line.split(separator)) > 2:
                        say(separator.join(line.split(separator)[:-2]))
                    if is_cut:
                        continue
                    say(line)
                    if random.random() < 0.02:
                        say(noise[random.integers(len(noise))])
                if style in ("blank", "dashes", "words"):
                    say({"blank": "", "dashes": "--------", "words": "end of frame"}[style])
            if style == "blank" and stamps:
                lines = [line if not line.endswith("-> ") else "" for line in lines]
            path.write_text("\n".join(lines) + "\n")
            whole = np.delete(frames, sorted(cut), axis=0)

            def read():
                recording = pf.Recording(path, frame_size=(rows, cols), rate_hz=None if stamps else 20)
                return recording[:]

            def is_right(found, _):
                return found.shape == whole.shape and np.array_equal(found, whole)
            return style + (" stamps" if stamps else ""), read, is_right, "\n".join(lines)
        self.judge("logs", world, 0.85)

    def test_rows_columns_and_single_sensels(self):
        def world(random, path):
            count = int(random.integers(1, 40))
            rows, cols = [(1, count), (count, 1), (1, 1)][random.integers(3)]
            frames = random.integers(1, 900, (int(random.integers(12, 30)), rows, cols)).astype(np.uint16)
            door = ["array", "npy", "text", "recording"][random.integers(4)]
            if door == "text":
                path.write_text("".join(",".join(map(str, frame.ravel())) + "\n" for frame in frames))
            if door == "npy":
                path = path.with_suffix(".npy")
                np.save(path, frames)

            def read():
                options = {"counts_per_newton": 100, "contacts": bool(random.integers(2))}
                if door == "recording":
                    pf.save_recording(path.with_suffix(".h5"), frames, rate_hz=10, axes="frames,rows,columns",
                                      overwrite=True)
                source = {"array": frames, "recording": path.with_suffix(".h5")}.get(door)
                if source is None:
                    source = pf.Recording(path, frame_size=(rows, cols), rate_hz=10,
                                          axes="" if door == "text" else "frames,rows,columns")
                axes = "frames,rows,columns" if door == "array" else ""
                forces = pf.solve(source, axes=axes, layout="sensels", **options)
                forces.save(WORK / "shape.h5", overwrite=True)
                return pf.open(WORK / "shape.h5")[:].normal
            return (f"{door} {'1 x 1' if rows * cols == 1 else '1 x N' if rows == 1 else 'N x 1'}", read,
                    lambda normal, _: np.allclose(normal, frames / 100, rtol=1e-5), f"{rows} x {cols}")
        self.judge("shapes", world, 0.95)


if __name__ == "__main__":
    unittest.main()
