"""The cache of compiled kernels: trusted directories and messages."""

import os
import pathlib
import resource
import signal
import subprocess
import time
import unittest

from command import BALL, PROGRAM, CommandTest, on_terminal, run


def environment(**changes):
    """The environment with `changes` as its only variables of the kernel cache."""
    kept = {name: value for name, value in os.environ.items()
            if name not in ("POCL_CACHE_DIR", "XDG_CACHE_HOME", "HOME", "TMPDIR")}
    return kept | {name: str(value) for name, value in changes.items()}


class KernelCache(CommandTest):
    def setUp(self):
        super().setUp()
        scene = self.folder / "scene.toml"
        scene.write_text(BALL)
        self.recording = self.folder / "recording.h5"
        self.outputs = 0
        run("simulate", scene, "-o", self.recording)

    def directory(self, *parts, mode=0o700):
        path = self.folder.joinpath(*parts)
        path.mkdir(parents=True)
        path.chmod(mode)
        return path

    def output(self):
        """The path of a new file."""
        self.outputs += 1
        return self.folder / f"forces_{self.outputs}.npy"

    def solve(self, *more, **changes):
        """Solves in the environment `changes`."""
        command = [PROGRAM, "solve", self.recording, "--device", "opencl", "-o", self.output(), *more]
        return subprocess.run(command, capture_output=True, text=True, timeout=600, check=False,
                              env=environment(**changes))

    def test_kernels_lie_where_only_this_user_writes(self):
        self.assertEqual(self.solve(HOME=self.folder / "home").returncode, 0)
        self.assertTrue(list((self.folder / "home/.cache/pillarfield/kernels").rglob("*.so")))
        open_to_all = self.directory("shared", mode=0o777)
        link = self.directory("linked") / ".cache"
        link.symlink_to(open_to_all, target_is_directory=True)
        result = self.solve(XDG_CACHE_HOME=open_to_all, HOME=link.parent)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        result = self.solve(POCL_CACHE_DIR=open_to_all)
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, r"^pillarfield: POCL_CACHE_DIR: others can write .*\n$")
        self.assertEqual(list(open_to_all.rglob("*.so")), [])

    def test_info_names_the_directory(self):
        home = self.directory("home")
        command = [PROGRAM, "info", "--devices", "--json"]
        for changes, place, reason in (
                ({"HOME": home}, str(home / ".cache/pillarfield/kernels"), ""),
                ({"HOME": "/proc/nope"}, "", "/proc/nope cannot be made")):
            result = subprocess.run(command, capture_output=True, text=True, check=True,
                                    env=environment(**changes))
            self.assertIn(f'"kernel_cache":"{place}","kernels_not_kept":"{reason}', result.stdout)

    def test_compiling_is_announced_on_a_terminal(self):
        home = self.directory("home")
        self.assertIn(f"the next start finds them in {home}/.cache/pillarfield/kernels",
                      self.messages(HOME=home))
        shared = pathlib.Path("/tmp/pocl").exists()
        temporary = self.directory("temporary")
        self.assertIn("as at every start: HOME and XDG_CACHE_HOME are not set",
                      self.messages(TMPDIR=temporary))
        self.assertEqual(list(temporary.iterdir()), [])
        self.assertEqual(pathlib.Path("/tmp/pocl").exists(), shared)
        self.assertNotIn("Compiling", self.messages("--quiet", HOME=self.directory("other")))

    def test_an_interrupt_does_not_disturb_the_compiler(self):
        cache = self.directory("interrupted")
        process = subprocess.Popen([PROGRAM, "solve", self.recording, "--device", "opencl", "-o",
                                    self.output()], text=True,
                                   stderr=subprocess.PIPE, stdout=subprocess.PIPE,
                                   env=environment(POCL_CACHE_DIR=cache))
        # Handlers of the compiler would remove the file that it is writing.
        while process.poll() is None and not list(cache.rglob("*.tmp")):
            time.sleep(0.0005)
        process.send_signal(signal.SIGINT)
        messages = process.communicate(timeout=120)[1]
        if process.returncode != 0:  # else it ended before
            self.assertRegex(messages, r"\Apillarfield: .*: interrupted .*\n\Z")

    def messages(self, *more, **changes):
        """Messages of solving on a terminal."""
        status, _, messages = on_terminal(
            [PROGRAM, "solve", self.recording, "--device", "opencl", "-o", self.output(), *more],
            env=environment(**changes))
        self.assertEqual(status, 0, messages)
        return messages

    @unittest.skipIf("ASAN_OPTIONS" in os.environ, "AddressSanitizer needs much address space")
    def test_a_limited_address_space_is_reported(self):
        limit = 200 << 20
        for command in (["solve", self.recording, "--device", "opencl", "-o", self.folder / "a.npy"],
                        ["info", "--devices"]):
            result = subprocess.run(
                [PROGRAM, *command], capture_output=True, text=True, check=False,
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
            self.assertIn("limited to 200 MiB: raise the limit (ulimit -v)",
                          result.stdout + result.stderr)


if __name__ == "__main__":
    unittest.main()
