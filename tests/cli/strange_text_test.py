"""Invalid UTF-8 and terminal escapes in files and their names."""

import json
import os
import shutil
import subprocess
import unittest

import h5py
import numpy

from command import BALL, PROGRAM, CommandTest, run

SCENE = BALL.replace("A ball", "{title}").replace("frames = 6", "frames = 24")

ESCAPES = "a\x1b[31mb\x1b]0;c\x07\x9b2Jd\x7f"
ESCAPED = r"a\u001b[31mb\u001b]0;c\u0007\u009b2Jd\u007f"


def output_of(*arguments, expect=0):
    """The bytes on standard output and error."""
    result = subprocess.run([PROGRAM, *arguments], capture_output=True, timeout=600, check=False)
    assert result.returncode == expect, (arguments, result)
    return result.stdout, result.stderr


class StrangeText(CommandTest):
    def setUp(self):
        super().setUp()
        self.scene = self.folder / "scene.toml"
        self.scene.write_text(SCENE.format(title="A ball"))

    def assert_harmless(self, output):
        """The output is UTF-8 without control characters except line ends."""
        text = output.decode()
        self.assertTrue(text.replace("\n", "").isprintable(), repr(text))
        return text

    def test_json_is_valid_for_any_file_name(self):
        def name(text):
            return os.fsencode(self.folder) + b"/" + text

        recording, forces, table = name(b"i\xffn.h5"), name(b"f\xfe.h5"), name(b"c\xfd.json")
        calibration = name(b"k\xff.h5")
        for words in (["simulate", self.scene, "-o", recording], ["solve", recording, "-o", forces, "--contacts", table],
                      ["info", forces], ["compare", forces, recording],
                      ["stream", recording, "--rate", "100", "--summary"],
                      ["calibrate", "tare", recording, "--preloaded", "-o", calibration], ["info", calibration],
                      ["calibrate", "apply", calibration, recording, "-o", name(b"l\xff.h5")]):
            said = output_of(*words, "--json")[0]
            json.loads(said)
            self.assertTrue(words[0] == "compare" or "\ufffd" in said.decode(), words)
        with open(table, "rb") as file:
            self.assertEqual(json.loads(file.read().decode())["source"], "i\ufffdn.h5")
        for command in (["info", forces], ["info", calibration], ["compare", forces, recording]):
            self.assert_harmless(output_of(*command)[0])

    def test_texts_of_files_are_escaped(self):
        recording = self.folder / "recording.h5"
        forces = self.folder / "forces.h5"
        run("simulate", self.scene, "-o", recording)
        run("solve", recording, "-o", forces)
        for kind in ("source", "device", "estimator"):
            changed = self.folder / f"{kind}.h5"
            shutil.copy(forces, changed)
            with h5py.File(changed, "r+") as file:
                file.attrs[kind] = numpy.bytes_(ESCAPES.encode())
            output, error = self.either("info", changed)
            self.assertIn(ESCAPED, output + error)
        escapes_in_toml = "".join(f"\\u{ord(character):04x}" for character in ESCAPES)
        self.scene.write_text(SCENE.format(title=escapes_in_toml))
        self.assertIn(ESCAPED, self.either("info", self.scene)[0])
        self.assertIn(ESCAPED, self.either("simulate", self.scene, "-o",
                                           self.folder / "again.h5")[0])
        self.scene.write_text(SCENE.format(title="") + f'"{escapes_in_toml}" = 1\n')
        self.assertIn(ESCAPED, self.either("info", self.scene)[1])

    def test_names_of_files_are_escaped(self):
        absent = self.folder / f"{ESCAPES}.h5"
        for command in (["info", absent], ["solve", absent, "-o", "a.h5"],
                        ["compare", absent, absent], ["stream", absent],
                        ["calibrate", "tare", absent, "-o", "a.h5"]):
            self.assertIn(ESCAPED, self.either(*command)[1])
        self.assertIn(ESCAPED, self.either("simulate", self.scene, "-o", absent)[0])
        self.assertIn(ESCAPED, self.either("solve", absent, "-o", f"{absent}.npy")[0])

    def either(self, *arguments):
        """Output and error of the command, checked, with exit status 0 or 1."""
        result = subprocess.run([PROGRAM, *arguments], capture_output=True, timeout=600,
                                check=False)
        self.assertIn(result.returncode, (0, 1))
        return self.assert_harmless(result.stdout), self.assert_harmless(result.stderr)


if __name__ == "__main__":
    unittest.main()
