"""What LeRobot 0.6.2 has of cameras, as far as a plugin needs it: import this before the plugin."""

import abc
import dataclasses
import sys
import types
from typing import Optional


@dataclasses.dataclass(kw_only=True)
class CameraConfig(abc.ABC):
    fps: Optional[int] = None
    width: Optional[int] = None
    height: Optional[int] = None
    choices = {}

    @classmethod
    def register_subclass(cls, name):
        return lambda subclass: cls.choices.setdefault(name, subclass)


class Camera(abc.ABC):
    def __init__(self, config):
        self.fps, self.width, self.height = config.fps, config.width, config.height

    def __enter__(self):
        self.connect()
        return self

    def __exit__(self, *_):
        self.disconnect()


for name in ("is_connected", "find_cameras", "connect", "read", "async_read", "disconnect"):
    setattr(Camera, name, abc.abstractmethod(lambda self: None))
Camera.__abstractmethods__ = frozenset(
    ("is_connected", "find_cameras", "connect", "read", "async_read", "disconnect"))


class DeviceNotConnectedError(ConnectionError):
    pass


class DeviceAlreadyConnectedError(ConnectionError):
    pass


for name in ("lerobot", "lerobot.cameras", "lerobot.utils", "lerobot.utils.errors"):
    sys.modules[name] = types.ModuleType(name)
sys.modules["lerobot.cameras"].__dict__.update(Camera=Camera, CameraConfig=CameraConfig)
sys.modules["lerobot.utils.errors"].__dict__.update(
    DeviceNotConnectedError=DeviceNotConnectedError,
    DeviceAlreadyConnectedError=DeviceAlreadyConnectedError)
