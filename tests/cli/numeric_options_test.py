"""Every option that takes a number refuses what is none, in every command."""

import re
import subprocess
import unittest

from command import PROGRAM, CommandTest, run

SCENE = """
[skin]
pillars = [4, 4]
[[contact]]
shape = "sphere"
motion = "press"
contact_radius_mm = 3
load_n = 2
position_mm = [0, 0]
"""

# A number's name in the help of an option; texts have TEXT.
KINDS = r"(?:FLOAT|UINT|INT|NUMBER|WHOLE NUMBER|RATIO|SECONDS|FRAMES|FLOAT,\.\.\.)"


class NumericOptions(CommandTest):
    def commands(self):
        """Each command with what it needs; its output must not come to be."""
        recording = self.folder / "recording.h5"
        output = self.folder / "output.h5"
        calibrate = {step: ["calibrate", step, recording, "--calibration", recording, "-o", output]
                     for step in ("tare", "equilibrate", "load", "faults")}
        calibrate["equilibrate"] += ["--pressure-kpa", "10"]
        calibrate["load"] += ["--load-n", "10"]
        return [["simulate", self.scene, "-o", output],
                ["solve", recording, "-o", output, "--contacts", output],
                ["live", recording], ["testbed"], *calibrate.values()]

    def setUp(self):
        super().setUp()
        self.scene = self.folder / "scene.toml"
        self.scene.write_text(SCENE)
        run("simulate", self.scene, "-o", self.folder / "recording.h5")

    def options_of(self, command):
        """The command's options that take numbers, by its help: their names and what they take."""
        words = command[:2] if command[0] == "calibrate" else command[:1]
        text = run(*words, "--help").stdout
        options = {}
        for name, kind in re.findall(r"^  (?:-\w,)?(--[\w-]+) ([^\n]*)$", text, re.MULTILINE):
            if re.match(KINDS, kind) or not kind.startswith(("TEXT", " ")):
                options[name] = kind
        return options

    def test_what_is_no_number_is_refused(self):
        tried = 0
        for command in self.commands():
            options = self.options_of(command)
            for option in options:
                for value in ("nan", "-inf", "1e999"):
                    result = subprocess.run([PROGRAM, *command, f"{option}={value}"],
                                            capture_output=True, text=True, timeout=20, check=False)
                    with self.subTest(command=command[:2], option=option, value=value):
                        self.assertIn(result.returncode, (1, 2), result.stderr)
                        lines = [line for line in result.stderr.splitlines()
                                 if line != "Run with --help for more information."]
                        self.assertEqual(len(lines), 1, result.stderr)
                    tried += 1
        self.assertGreater(tried, 3 * 30)
        self.assert_folder_holds("recording.h5", "scene.toml")

    def test_seeds_are_whole_numbers_that_scenes_may_have(self):
        for command in (["simulate", self.scene, "-o", self.folder / "a.h5"],
                        ["testbed", "--runs", "2"]):
            for seed in ("-1", "1.5", "0x10", "010", "9223372036854775808",
                         "99999999999999999999", "18446744073709551617", " 1"):
                self.assertIn("whole number from 0 to 9223372036854775807",
                              run(*command, f"--seed={seed}", expect=2).stderr)
            run(*command, "--seed", "9223372036854775807")

    def test_counts_are_whole_numbers(self):
        simulate = ["simulate", self.scene, "-o", self.folder / "a.h5"]
        for frames in ("-1", "0", "1.5", "4294967297", "18446744073709551617"):
            self.assertIn("whole number from 1 to 100000000",
                          run(*simulate, f"--frames={frames}", expect=2).stderr)


if __name__ == "__main__":
    unittest.main()
