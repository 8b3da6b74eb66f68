"""The camera: a thread solves every frame, and reading shows the newest result."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from typing import Any, Optional

import numpy as np

import pillarfield as pf
from lerobot.cameras import Camera
from lerobot.utils.errors import DeviceAlreadyConnectedError, DeviceNotConnectedError

from .config import PillarfieldCameraConfig
from .rendering import Image, check_rendering, image_of

_PATIENCE_S = 0.1  # from a wish to stop to the end of the thread
_READ_TIMEOUT_MS = 10_000  # of read(), as of LeRobot's own cameras


class PillarfieldCamera(Camera):
    """The live field of force of a tactile skin as an RGB image, uint8 [height, width, 3].

    Every frame is solved, whether it is read or not.
    """

    def __init__(self, config: PillarfieldCameraConfig) -> None:
        super().__init__(config)
        self.config = config
        self._changed = threading.Condition()
        self._stop = threading.Event()
        self._thread: Optional[threading.Thread] = None
        self._forget()

    def __str__(self) -> str:
        return f"PillarfieldCamera({self.config.source})"

    def _forget(self) -> None:
        self._forces: Optional[pf.ForceField] = None
        self._arrival_s = 0.0
        self._is_new = False
        self._failure = ""

    @property
    def is_connected(self) -> bool:
        """True from connect() to disconnect()."""
        return self._thread is not None

    @staticmethod
    def find_cameras() -> list[dict[str, Any]]:
        """Not possible: nothing tells which device is a skin."""
        raise NotImplementedError("a tactile skin cannot be found; give its source")

    def connect(self, warmup: bool = True) -> None:
        """Opens the source, waits for its first frame, and measures the tare if one is wanted.

        warmup: wait for the first image too
        """
        if self.is_connected:
            raise DeviceAlreadyConnectedError(f"{self} is already connected.")
        source = pf.live(self.config.source, layout=self.config.layout)
        try:
            plan = self._plan_of(source)
            check_rendering(self.config.rendering, plan.skin.layout)
            self._set_size(plan.skin)
            processor = pf.Processor(plan)
        except BaseException:
            source.close()
            raise
        self._forget()
        self._stop.clear()
        self._thread = threading.Thread(target=self._run, args=(source, processor))
        self._thread.start()
        if warmup:
            try:
                self.read()
            except BaseException:
                self.disconnect()
                raise

    def _plan_of(self, source: pf.LiveSource) -> pf.Plan:
        config = self.config
        calibration = pf.Calibration.load(config.calibration) if config.calibration else None
        scale = config.counts_per_newton or (calibration and calibration.counts_per_newton)
        if not scale:
            raise pf.Error(str(self), "nothing gives its counts per newton",
                           "give counts_per_newton, or a calibration that has them")
        if config.tare_frames:
            whole = (frame.readings for frame in source if not frame.missing)
            unloaded = np.stack([readings for _, readings in zip(range(config.tare_frames), whole)])
            calibration = pf.calibrate.tare(unloaded, calibration, skin=source.skin).calibration
        return pf.Plan(source.skin, sensel_type=source.sensel_type, calibration=calibration,
                       counts_per_newton=scale)

    def _set_size(self, skin: pf.Skin) -> None:
        self.height = self.config.height or skin.element_rows
        self.width = self.config.width or skin.element_cols
        if self.height < skin.element_rows or self.width < skin.element_cols:
            raise pf.Error(str(self), f"an image of {self.width} x {self.height} pixels would leave out forces",
                           f"give width and height of {skin.element_cols} x {skin.element_rows} or more")

    def _run(self, source: pf.LiveSource, processor: pf.Processor) -> None:
        def frames() -> Iterator[pf.Frame]:
            # A program may end without disconnect().
            while not self._stop.is_set() and threading.main_thread().is_alive():
                try:
                    frame = source.receive(_PATIENCE_S)
                except StopIteration:
                    return
                if frame is not None:
                    yield frame

        failure = "the source ended"
        try:
            with source, processor:
                for forces in processor.stream(frames()):
                    with self._changed:
                        self._forces, self._arrival_s, self._is_new = forces, time.monotonic(), True
                        self._changed.notify_all()
        except Exception as error:  # For those who read.
            failure = str(error)
        with self._changed:
            self._failure = failure
            self._changed.notify_all()

    def read(self) -> Image:
        """The image of the next frame to come."""
        with self._changed:
            self._is_new = False
        return self.async_read(_READ_TIMEOUT_MS)

    def async_read(self, timeout_ms: float = 200) -> Image:
        """The image of the newest frame that async_read() has not shown; waits for one.

        Raises TimeoutError if none comes in time, ConnectionError if none will come.
        """
        self._check_connected()
        with self._changed:
            self._changed.wait_for(lambda: self._is_new or self._failure, timeout_ms / 1000)
            forces, is_new, self._is_new = self._forces, self._is_new, False
        if not is_new or forces is None:
            self._check_running()
            raise TimeoutError(f"{self}: no frame came within {timeout_ms:g} ms.")
        return self._image_of(forces)

    def read_latest(self, max_age_ms: int = 500) -> Image:
        """The image of the newest frame, at once.

        Raises TimeoutError if it is older than max_age_ms, RuntimeError if there was none.
        """
        self._check_connected()
        with self._changed:
            forces, age_ms = self._forces, 1000 * (time.monotonic() - self._arrival_s)
        self._check_running()
        if forces is None:
            raise RuntimeError(f"{self}: no frame came yet.")
        if age_ms > max_age_ms:
            raise TimeoutError(f"{self}: the newest frame is {age_ms:.0f} ms old.")
        return self._image_of(forces)

    def disconnect(self) -> None:
        """Closes the source."""
        self._check_connected()
        assert self._thread is not None
        self._stop.set()
        self._thread.join()
        self._thread = None
        self._forget()

    def _check_connected(self) -> None:
        if not self.is_connected:
            raise DeviceNotConnectedError(f"{self} is not connected.")

    def _check_running(self) -> None:
        if self._failure:
            raise ConnectionError(f"{self}: {self._failure}.")

    def _image_of(self, forces: pf.ForceField) -> Image:
        assert self.height is not None and self.width is not None
        return image_of(forces, self.config.rendering, self.config.full_scale_n, self.height, self.width)
