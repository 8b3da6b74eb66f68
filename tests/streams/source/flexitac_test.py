"""Frames of a FlexiTac board on a pseudo-terminal, through the program, with and without lost bytes."""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy

PROGRAM = os.environ["PILLARFIELD"]
BOARD = pathlib.Path(__file__).with_name("flexitac_board.py")
ROWS, COLS, RATE, FRAMES = 16, 32, 100, 300


class FlexitacTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def start(self, *words, **options):
        process = subprocess.Popen([str(word) for word in words], text=True, stdout=subprocess.PIPE,
                                   **options)
        self.addCleanup(lambda: (process.kill(), process.communicate()))
        return process

    def stream(self, loses):
        """The random frames sent, those recorded, and the summary of the program."""
        sent, recording = self.folder / "sent.npy", self.folder / "recording.h5"
        board = self.start(sys.executable, BOARD, ROWS, COLS, RATE, FRAMES, loses, sent,
                           stdin=subprocess.PIPE)
        device = board.stdout.readline().strip()
        stream = self.start(PROGRAM, "stream", f"serial:{device}?protocol=flexitac&rows={ROWS}&cols={COLS}",
                            "--record", recording, "--health-interval", 0.1, "--json", stderr=subprocess.DEVNULL)

        def wait_for(frames):
            while json.loads(stream.stdout.readline())["health"]["frames"] < frames:
                pass

        wait_for(1)
        print("go", file=board.stdin, flush=True)
        wait_for(int(board.stdout.readline()))  # Then those that were discarded before have been made up for.
        stream.send_signal(signal.SIGINT)
        summary = json.loads(stream.communicate(timeout=600)[0].splitlines()[-1])["summary"]
        self.assertEqual(stream.returncode, 0)
        with h5py.File(recording) as file:
            self.assertEqual(file["skin"].attrs["layout"], b"sensels")
            frames = file["frames/raw"][()]
        self.assertEqual(len(frames), summary["frames"])
        self.assertEqual(frames.dtype, numpy.uint8)
        return numpy.load(sent), frames[frames.any(axis=(1, 2))], summary

    def test_with_lost_bytes_every_frame_is_right_or_counted(self):
        sent, recorded, summary = self.stream(loses=100)
        numbers = {frame.tobytes(): number for number, frame in enumerate(sent)}
        came = [numbers[frame.tobytes()] for frame in recorded]
        self.assertEqual(came, sorted(set(came)))
        self.assertEqual(len(sent), len(came) + summary["lost"])
        self.assertGreaterEqual(summary["lost"], FRAMES // 100)
        self.assertLessEqual(summary["lost"], 3 * (FRAMES // 100))
        self.assertEqual(summary["invalid"], FRAMES // 100)


if __name__ == "__main__":
    unittest.main()
