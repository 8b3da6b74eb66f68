"""Resultant forces and torques against the truth, by the command and by independent NumPy code."""

import re
import unittest

import h5py
import numpy as np

from command import CommandTest, run, run_json

TWO_BALLS = """
title = "Two balls, and one that leaves"
[skin]
pillars = [30, 40]
threshold_counts = 3
[time]
frames = 4
rate_hz = 100
[sensor]
adc_bits = 10
noise_counts = 0.5
dead_zone_counts = 1
[[contact]]
shape = "sphere"
motion = "slide"
contact_radius_mm = 6
load_n = 12
position_mm = [-14, 3]
friction = 0.5
direction_deg = 30
[[contact]]
shape = "sphere"
motion = "spin"
contact_radius_mm = 5
load_n = 9
position_mm = [12, -5]
friction = 0.6
"""


def components(loaded):
    """Connected components (sides and corners) as lists of (row, column), by flood fill."""
    left = set(zip(*map(list, np.nonzero(loaded))))
    found = []
    while left:
        rest, part = [left.pop()], []
        while rest:
            row, col = rest.pop()
            part.append((row, col))
            near = {(row + i, col + j) for i in (-1, 0, 1) for j in (-1, 0, 1)} & left
            left -= near
            rest += near
        found.append(part)
    return found


def wrench(force, x, y, about=(0, 0)):
    """Sum of forces (pillars, 3), and their moment about a point of the skin."""
    arm = np.stack([x - about[0], y - about[1], np.zeros_like(x)], -1)
    on_skin = force * [1, 1, -1]  # pressing acts along -z
    return force.sum(0), np.cross(arm, on_skin).sum(0)


def rms(errors):
    return np.sqrt(np.mean(np.square(errors)))


def planes(file, group):
    return np.stack([file[group][name][:].astype(float)
                     for name in ("shear_x", "shear_y", "normal")], -1)


class Compare(CommandTest):
    def setUp(self):
        super().setUp()
        self.truth, self.forces = self.folder / "r.h5", self.folder / "f.h5"
        (self.folder / "s.toml").write_text(TWO_BALLS)
        run("simulate", self.folder / "s.toml", "-o", self.truth)
        run("solve", self.truth, "-o", self.forces)

    def change(self, action):
        with h5py.File(self.forces, "r+") as file:
            action(file["force"])

    def check(self, given, expected):
        for key, value in expected.items():
            self.assertAlmostEqual(given[key], value, delta=1e-6 * max(1, abs(value)), msg=key)

    def compare_with_oracle(self):
        with h5py.File(self.truth) as file:
            truth, pitch = planes(file, "truth"), 2 * file["skin"].attrs["sensel_pitch_mm"]
        with h5py.File(self.forces) as file:
            solved, status = planes(file, "force"), file["force/status"][:] & 15
        frames, rows, cols, _ = truth.shape
        y, x = np.meshgrid(((rows - 1) / 2 - np.arange(rows)) * pitch,
                           (np.arange(cols) - (cols - 1) / 2) * pitch, indexing="ij")
        force, torque, force_true, torque_true = [], [], [], []
        by_contact = {"force": [], "torque": [], "centre": [], "true": []}
        found = missed = extra = 0
        for t in range(frames):
            f, m = wrench(solved[t].reshape(-1, 3), x.ravel(), y.ravel())
            f0, m0 = wrench(truth[t].reshape(-1, 3), x.ravel(), y.ravel())
            force.append(np.linalg.norm(f - f0))
            torque.append(np.linalg.norm(m - m0))
            force_true.append(np.linalg.norm(f0))
            torque_true.append(np.linalg.norm(m0))
            true_parts, parts = components(truth[t].any(-1)), components(status[t])
            pairs = sorted(((len(set(a) & set(b)), i, j) for i, a in enumerate(true_parts)
                            for j, b in enumerate(parts)), reverse=True)
            used_true, used = set(), set()
            for shared, i, j in pairs:
                if not shared or i in used_true or j in used:
                    continue
                used_true.add(i)
                used.add(j)
                a, b = tuple(zip(*true_parts[i])), tuple(zip(*parts[j]))
                normal = truth[t][a][:, 2]
                centre = np.array([normal @ x[a], normal @ y[a]]) / normal.sum()
                normal = solved[t][b][:, 2]
                shown = np.array([normal @ x[b], normal @ y[b]]) / normal.sum()
                f0, m0 = wrench(truth[t][a], x[a], y[a], centre)
                f, m = wrench(solved[t][b], x[b], y[b], centre)
                by_contact["force"].append(np.linalg.norm(f - f0))
                by_contact["torque"].append(abs(m[2] - m0[2]))
                by_contact["centre"].append(np.linalg.norm(shown - centre))
                by_contact["true"].append(np.linalg.norm(f0))
            found += len(used)
            missed += len(true_parts) - len(used_true)
            extra += len(parts) - len(used)
        given = run_json("compare", self.forces, self.truth)
        self.check(given["resultant"], {
            "true_rms_n": rms(force_true), "error_rms_n": rms(force),
            "worst_error_n": max(force), "worst_frame": int(np.argmax(force)),
            "true_torque_rms_nmm": rms(torque_true), "torque_error_rms_nmm": rms(torque),
            "worst_torque_error_nmm": max(torque)})
        self.check(given["contacts"], {
            "found": found, "missed": missed, "extra": extra,
            "true_rms_n": rms(by_contact["true"]), "error_rms_n": rms(by_contact["force"]),
            "worst_error_n": max(by_contact["force"]),
            "torque_error_rms_nmm": rms(by_contact["torque"]),
            "worst_torque_error_nmm": max(by_contact["torque"]),
            "centre_error_rms_mm": rms(by_contact["centre"]),
            "worst_centre_error_mm": max(by_contact["centre"])})
        return given

    def test_agrees_with_numpy(self):
        contacts = self.compare_with_oracle()["contacts"]
        self.assertEqual((contacts["found"], contacts["missed"], contacts["extra"]), (8, 0, 0))

    def test_missed_and_extra_contacts(self):
        def change(force):
            for name in ("shear_x", "shear_y", "normal", "status"):
                force[name][1, :, :20] = 0  # the left ball is missed in one frame
            force["status"][2, 0, 0], force["normal"][2, 0, 0] = 15, 0.25
            force["shear_x"][3] *= 1.5
        self.change(change)
        contacts = self.compare_with_oracle()["contacts"]
        self.assertEqual((contacts["found"], contacts["missed"], contacts["extra"]), (7, 1, 1))
        self.assertAlmostEqual(contacts["extra_normal_n"], 0.25)
        text = run("compare", self.forces, self.truth).stdout
        self.assertRegex(text, r"Contacts: 7 found, 1 missed \(of at most 1[12][.\d]* N\), 1 extra "
                               r"\(of at most 0.25 N\)")

    def test_errors_of_any_size_keep_their_columns(self):
        self.change(lambda force: force["normal"].write_direct(1e6 * force["normal"][:]))
        text = run("compare", self.forces, self.truth).stdout
        self.assertIn("> 999%", text)
        self.assertLessEqual(max(float(value) for value in re.findall(r"([\d.e+]+)%", text)), 999)
        lines = text.splitlines()
        self.assertEqual({len(line) for line in lines if line.endswith("%")}, {74, 91})
        rows = [line for line in lines if line[:8].strip() in ("1", "2", "3", "4", "loaded")]
        self.assertEqual((len(rows), {len(row) for row in rows}), (5, {len(lines[3])}), text)


if __name__ == "__main__":
    unittest.main()
