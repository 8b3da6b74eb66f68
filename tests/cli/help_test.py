"""Help, wrong command lines, --quiet and --version of every command."""

import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import unittest

import numpy as np

from command import PROGRAM, SOURCE, CommandTest, on_terminal, run

STEPS = re.findall(r"^  (\w+) ", run("calibrate", "--help").stdout.split("\n\n")[2], re.MULTILINE)
COMMANDS = [["simulate"], ["solve"], ["stream"], ["compare"], ["calibrate"],
            *(["calibrate", step] for step in STEPS), ["info"], ["doctor"], ["completion"]]


def examples_of(command):
    """The examples of a command's help."""
    return [line.strip() for line in run(*command, "--help").stdout.split("\nExamples:\n")[1]
            .splitlines()]


class Help(CommandTest):
    def test_every_command_explains_itself(self):
        for command in [[], *COMMANDS]:
            name = " ".join(["pillarfield", *command])
            with self.subTest(command=name):
                text = run(*command, "--help").stdout
                self.assertEqual(run("help", *command).stdout, text)
                usage, options = text.split("\nExamples:\n")[0].split("\n\n", 2)[1:]
                self.assertTrue(usage.startswith("Usage: " + name), usage)
                self.assertTrue(text.replace("\n", "").isprintable())
                self.assertLessEqual(max(map(len, options.splitlines())), 80)
                self.assertRegex(options, r"(?m)^General:\n(  .*\n)*  -h, --help +Print")
                self.assertNotRegex(options, "TEXT|FLOAT|UINT|REQUIRED|Options:")
                own = [line for line in examples_of(command) if name in line]
                self.assertGreaterEqual(len(own), 1 if command[:1] == ["calibrate"] else 2)

    def run_examples(self, more, check):
        """Runs the examples of each command with `more` arguments on a terminal in a new folder, and calls
        check(line, output, messages)."""
        environment = dict(os.environ, PATH=os.pathsep.join(
            [str(pathlib.Path(PROGRAM).parent), os.environ["PATH"]]))
        for command in COMMANDS:
            folder = self.folder / "_".join([*command, *more])
            folder.mkdir()
            (folder / "scenes").symlink_to(SOURCE / "scenes")
            for line in examples_of(command):
                if not line.startswith("pillarfield ") or "completion" in line:
                    words = ["bash", "-c", line]
                else:
                    words = [PROGRAM, *shlex.split(line)[1:], *more]
                with self.subTest(line=line, more=more):
                    status, out, messages = on_terminal(words, cwd=folder, env=environment)
                    self.assertEqual(status, 0, messages)
                    check(line, out, messages)

    def test_examples_work_and_print_numbers_for_people(self):
        def check(line, out, _):
            if "--json" not in line and "--kernel" not in line:
                self.assertNotRegex(out, r"\d\.\d{6}|\d\.\d+e|[1-9]\.\d{5}|(?<![\w.])\d{6}")
        self.run_examples([], check)

    def test_quiet_is_quiet(self):
        def check(line, out, messages):
            self.assertEqual(messages, "")
            if " -o " in line:
                self.assertEqual(out, "")
        self.run_examples(["-q"], check)


class Version(CommandTest):
    def test_it_names_the_build(self):
        facts = json.loads(run("--version", "--json").stdout)
        self.assertEqual(list(facts), ["version", "commit", "compiler", "build_type", "hdf5"])
        self.assertRegex(facts["version"], r"^\d+\.\d+\.\d+$")
        self.assertRegex(facts["hdf5"], r"^\d+\.\d+\.\d+$")
        self.assertRegex(facts["commit"], r"^([0-9a-f]{10}|.*-g?[0-9a-f]{10})(-dirty)?$|unknown")
        text = run("--version").stdout
        self.assertTrue(text.startswith(f"pillarfield {facts['version']}\n"))
        for key in ("commit", "compiler", "build_type", "hdf5"):
            self.assertIn(facts[key], text)

    def test_it_loads_no_opencl_driver(self):
        """A driver that ends the process, such as PoCL without /sys, must not keep the version secret."""
        (self.folder / "driver.icd").write_text("libno_such_driver.so\n")
        environment = os.environ | {"OCL_ICD_VENDORS": str(self.folder), "LD_DEBUG": "files"}
        self.assertIn("libno_such_driver", run("info", "--devices", env=environment).stderr)
        self.assertNotIn("libno_such_driver", run("--version", env=environment).stderr)


class WrongCommandLines(CommandTest):
    def test_the_nearest_word_is_suggested(self):
        solve = ("solve", "a", "-o", "b.h5")
        for meant, *arguments in (
                ("solve", "slove"), ("simulate", "sim", "x"), ("tare", "calibrate", "tear", "a"),
                ("--version", "--verison"), ("--threshold", *solve, "--thresold", 3),
                ("--threshold", *solve, "--thresold=3"), ("--rate", "stream", "a", "--rat", 3),
                ("direct", *solve, "--estimator", "direckt"), ("linear", "calibrate", "load", "a",
                "--model", "liner"), ("angles", *solve, "--outputs", "forces,angels"),
                ("bash", "completion", "bsh"), ("solve", "help", "solv"), ("tare", "help", "calibrate", "tar")):
            self.assert_fails(*arguments, status=2, names=[f"; did you mean '{meant}'?"])
        for arguments in (["fly"], [*solve, "--helicopter"], [*solve, "--estimator", "magic"]):
            self.assertNotIn("mean", self.assert_fails(*arguments, status=2, names=[arguments[-1]]))

    def test_each_ends_with_2_and_names_the_fault(self):
        solve = ("solve", "a", "-o", "b")
        step = ("a", "--calibration", "c", "-o", "d")
        press = ("calibrate", "equilibrate", *step)
        load = ("calibrate", "load", *step, "--load-n")
        for fault, *arguments in (
                ("no command", ), ("no command", "calibrate"), ("INPUT", "solve"),
                ("--output", "solve", "a"), ("one argument too many", "simulate", "a", "-o", "b", "c"),
                ("--seed", "simulate", "--seed", "x"),
                ("much", *solve, "--threshold", "much"),
                ("--minimum-pillars requires --contacts", *solve, "--minimum-pillars", 4),
                ("--friction", *solve, "--friction", 0.05), ("20", *solve, "--friction", 20),
                ("--frames", "simulate", "a", "-o", "b", "--frames", 0),
                ("--devices", "info", "file", "--devices"), ("tcsh", "completion", "tcsh"),
                ("UNLOADED", "calibrate", "tare"), ("--output", "calibrate", "tare", "a"),
                ("--pressure-kpa", *press), ("'0'", *press, "--pressure-kpa", 0),
                ("2 files and 1 values", *press, "b", "--pressure-kpa", 1),
                ("'-3'", *load, -3), ("1 files and 2 values", *load, "1,2"),
                ("2 files and 3 values", "calibrate", "shear", "b", *step, "--shear-n", "1,2,3"),
                ("1 files and 2 values", "calibrate", "memory", *step, "--pressure", "a,b"),
                ("radius-mm: it is 0", "calibrate", "bending", *step, "--radius-mm", 0, "--axis-deg", 0),
                ("cubic", *load, 1, "--model", "cubic"), ("RECORDING", "calibrate", "apply", "a"),
                ("--threshold-factor", "calibrate", "tare", "a", "-o", "b", "--threshold-factor",
                 -1), ("SOURCE", "stream"), ("fast", "stream", "a", "--rate", "fast"),
                ("--rate", "stream", "a", "--rate", 0), ("'nan'", "stream", "a", "--rate", "nan"),
                ("--rate", "stream", "a", "--rate", 1e6),
                ("--summary requires --rate", "stream", "a", "--summary"),
                *((f"{option}: '-5'", command, "a", *output, option, -5)
                  for command, output in (("solve", ("-o", "b", "--contacts", "c")), ("stream", ()))
                  for option in ("--counts-per-newton", "--threshold", "--full-scale", "--noise",
                                 "--parity-tolerance", "--contact-reach", "--pitch-mm"))):
            line = self.assert_fails(*arguments, status=2, names=[fault])
            self.assertRegex(line, r"; see 'pillarfield.* --help'$|; did you mean")

    def test_help_by_every_word(self):
        for word in ("help", "-h", "--help"):
            self.assertEqual(run(word, "solve").stdout, run("solve", "--help").stdout)
            self.assertEqual(run(word).stdout, run("--help").stdout)

    def test_a_remedy_works_as_it_is_typed(self):
        scene, recording = SOURCE / "scenes/touch/spin.toml", self.folder / "spin.h5"
        for command in (["solve", scene, "-o", "f.h5"], ["doctor", scene], ["calibrate", "tare", scene, "-o", "t.h5"]):
            line = self.assert_fails(*command, names=["is a scene"])
            run(*shlex.split(line.split("simulate it first: pillarfield ")[1]), cwd=self.folder)
            recording.unlink()
        run("simulate", scene, "-o", recording, "--uncalibrated")
        self.assert_fails("solve", recording, "-o", "f.h5", "--outputs", "uncertainty", names=["give --noise, or"])
        self.assert_fails("solve", recording, "-o", "f.h5", "--layout", "sensels", "--friction", 0.5,
                          names=["no pillars, but the plan has a friction coefficient"])
        for command in ("stream", "doctor"):
            self.assert_fails(command, "upd:127.0.0.1:9870", *(["-q"] if command == "stream" else []),
                              names=["did you mean 'udp:'?"])

    def test_notes_are_no_warnings_and_quiet_leaves_them_out(self):
        frames = np.random.default_rng(1).normal(100, 1, (30, 8, 12)).astype("f4")
        frames[25:, 2:5, 3:7] += 100
        np.save(self.folder / "mine.npy", frames)
        solve = ["solve", "mine.npy", "--rate", 50, "--tare-frames", 20, "--counts-per-newton", 300, "--pitch-mm", 5,
                 "-o", "f.h5", "--overwrite"]
        said = run(*solve, cwd=self.folder).stderr
        self.assertRegex(said, r"\Amine.npy: note: Read 30 frames .*\nmine.npy: note: Tare and noise are .*\n\Z")
        self.assertEqual(run(*solve, "-q", cwd=self.folder).stderr, "")
        report = json.loads(run(*solve, "--json", cwd=self.folder).stdout)
        self.assertEqual((len(report["notes"]), report["warnings"]), (2, []))

    def test_a_former_name_works_with_a_note(self):
        old = self.folder / "old.toml"
        old.write_text((SOURCE / "scenes/touch/rough_ball.toml").read_text().replace("[[indenter]]", "[[body]]"))
        messages = run("simulate", old, "-o", self.folder / "old_name.h5", "--frames", 2, "-q").stderr
        self.assertRegex(messages, r"\A.*old.toml: warning: \[\[body\]\] is now \[\[indenter\]\]; .*\n\Z")


class Numbers(CommandTest):
    """Every numeric option of every command refuses other text."""

    def test_other_text_is_refused(self):
        tried = 0
        for command in COMMANDS:
            text = run(*command, "--help").stdout
            options = re.findall(r"^  (--[\w-]+) ([A-Z][\w,.]*)", text, re.MULTILINE)
            for option in [name for name, kind in options
                           if kind not in ("FILE", "FOLDER", "DEVICE", "WORDS", "LIST", "SCENE", "NAME", "SINK",
                                            "SOCKET", "COLUMN", "UNIT")]:
                value = ("nan", "-inf", "1e999", "x")[tried % 4]
                with self.subTest(command=command, option=option, value=value):
                    self.assert_fails(*command, f"{option}={value}", status=2, names=[option, value])
                tried += 1
        self.assertGreater(tried, 35)

    def test_whole_numbers(self):
        for option, words, *values in (
                ("seed", "from 0 to 9223372036854775807", "-1", "1.5", "0x10", "010", "9223372036854775808", " 1"),
                ("frames", "from 1 to 100000000", "-1", "0", "1.5", "18446744073709551617")):
            for value in values:
                self.assert_fails("simulate", "scene.toml", "-o", "a.h5", f"--{option}={value}", status=2,
                                  names=[f"whole number {words}"])


# What zsh's completion system defines, with what it would offer printed.
ZSH = """
compdef() { :; }
_files() { print FILES; }
_describe() { [[ $1 == -o ]] && shift; print -l -- "${(P@)2}"; }
"""


class Completion(CommandTest):
    def complete(self, *words):
        """Completions of bash for the last of `words`."""
        script = run("completion", "bash").stdout + (
            f"PATH={pathlib.Path(PROGRAM).parent}:$PATH\n"
            f"COMP_WORDS=({' '.join(words)}); COMP_CWORD={len(words) - 1}; _pillarfield\n"
            'printf "%s\\n" "${COMPREPLY[@]}"\n')
        result = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True)
        return result.stdout.split()

    def test_bash(self):
        self.assertEqual(self.complete("pillarfield", "si"), ["simulate"])
        self.assertIn("--threshold", self.complete("pillarfield", "solve", "--th"))
        self.assertEqual(self.complete("pillarfield", "solve", "demo"), [])
        self.assertEqual(self.complete("pillarfield", "calibrate", "eq"), ["equilibrate"])
        self.assertEqual(self.complete("pillarfield", "calibrate", "tare", "--pre"),
                         ["--preloaded"])
        self.assertEqual(self.complete("pillarfield", "calibrate", "tare", "eq"), [])
        self.assertEqual(self.complete("pillarfield", "--vers"), ["--version"])
        self.assertEqual(self.complete("pillarfield", "solve", "a.h5", "--noise", "3", "--dev"),
                         ["--device"])

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not installed")
    def test_zsh(self):
        """Also as a function that zsh loads from its file."""
        function = self.folder / "_pillarfield"
        function.write_text(run("completion", "zsh").stdout)
        loads = (f". {function}", f"fpath=({self.folder}); autoload -U _pillarfield")
        def complete(load, *words):
            script = (f"{ZSH}{load}\nPATH={pathlib.Path(PROGRAM).parent}:$PATH\n"
                      f"words=({' '.join(words)}); CURRENT={len(words)}\n_pillarfield\n")
            return subprocess.run(["zsh", "-fc", script], capture_output=True, text=True,
                                  check=True).stdout.splitlines()
        for load in loads:
            commands = complete(load, "pillarfield", "si")
            self.assertIn("simulate:Make a recording from a scene: frames of the sensor and the true forces.", commands)
            self.assertEqual(commands[-1], "FILES")
            self.assertFalse([line for line in commands if line.startswith("-")])
            options = complete(load, "pillarfield", "solve", "--th")
            self.assertTrue([line for line in options if line.startswith("--threshold:")])
            self.assertTrue(all(line.startswith("--") for line in options), options)
            self.assertIn("--preloaded", " ".join(complete(load, "pillarfield", "calibrate", "tare", "--")))
            self.assertEqual(complete(load, "pillarfield", "solve", "x.h5"), ["FILES"])

    def test_other_shells(self):
        self.assertIn("complete -c pillarfield", run("completion", "fish").stdout)
        words = run("completion", "words", "--", "calibrate").stdout  # as fish calls it
        self.assertIn("\ntare\tTare, noise and threshold", "\n" + words)
        for shell in ("zsh", "fish"):
            if shutil.which(shell):
                script = self.folder / "script"
                script.write_text(run("completion", shell).stdout)
                subprocess.run([shell, "-n", script], check=True)


if __name__ == "__main__":
    unittest.main()
